-- 20 bodies of several shapes fall on each other between four walls, and come to rest.
local kinds = {
  { kind = "sphere", radius = 0.34 },
  { kind = "box", size = { 0.6, 0.45, 0.6 } },
  { kind = "penguin", height = 0.85 },
  { kind = "torus", major = 0.3, minor = 0.15 },
  { kind = "cylinder", radius = 0.28, height = 0.6 },
}
local colours = { "#E0782C", "#2E7FC2", "#4FA35A", "#C23B3B", "#C9A227" }

local bodies = {}
for i = 0, 19 do
  local column, layer = i % 4, i // 4
  table.insert(bodies, {
    shape = kinds[(i + layer) % 5 + 1],
    material = "jelly",
    position = { 0.95 * (column % 2) - 0.47, 0.6 + 0.95 * layer, 0.95 * (column // 2) - 0.47 },
    colour = colours[(2 * i + layer) % 5 + 1],
  })
end

return {
  title = "20 soft bodies rest on each other",
  pictures = { 1, 90, 240 },
  world = { frames = 360, contacts = "surface", sleep = true },
  framework = { half_width = 1.1, height = 1.5, thickness = 0.12, front_opacity = 0.12 },
  camera = { eye = { 0.5, 2.9, 4.3 }, target = { 0, 0.65, 0 }, near = 0.4, far = 40 },
  light = { shadow_radius = 4 },
  materials = { jelly = { cell_size = 0.11, half_width = 2, density = 200, alpha = 0.35, damping = 0.1 } },
  soft_body = bodies,
}
