-- A trampoline: a thin sheet in a frame, held by 32 ropes that give like springs. What falls onto it is thrown up again.
-- Try: `compliance` (m/N: by how much a spring gives), `damping_time` of the sheet, another `height` from which they fall.
local half, ring, height = 1.12, 1.5, 0.8 -- metres: of the sheet, of the frame, above the floor
local attach = {}

local function spring(x, z, to_x, to_z)
  table.insert(attach, { body = "sheet", rigid = "frame", kind = "rope", at = { x, height, z }, radius = 0.13, point = { to_x, height, to_z },
                         compliance = 0.0006, thickness = 0.022, colour = "#9AA3AB" })
end
for i = -3, 4 do
  local along = (i - 0.5) * 0.31
  for _, side in ipairs { -1, 1 } do
    spring(along, side * half, along * 1.15, side * ring)
    spring(side * half, along, side * ring, along * 1.15)
  end
end

local parts = {}
for _, side in ipairs { -1, 1 } do
  table.insert(parts, { kind = "capsule", radius = 0.06, height = 2 * ring + 0.12, position = { 0, height, side * ring }, rotation = { axis = { 0, 0, 1 }, degrees = 90 } })
  table.insert(parts, { kind = "capsule", radius = 0.06, height = 2 * ring + 0.12, position = { side * ring, height, 0 }, rotation = { axis = { 1, 0, 0 }, degrees = 90 } })
  for _, other in ipairs { -1, 1 } do
    table.insert(parts, { kind = "capsule", radius = 0.06, height = height + 0.05, position = { side * ring, height / 2, other * ring } })
  end
end

return {
  title = "bodies bounce on a trampoline",
  pictures = { 1, 60, 150 },
  world = { frames = 420, substeps = 4 },
  framework = { half_width = 2.6, height = 0.2, thickness = 0.15, front_opacity = 0.2 },
  light = { shadow_radius = 5 },
  camera = { eye = { 1.5, 2.5, 4.8 }, target = { 0, 0.95, 0 }, near = 0.5, far = 40 },
  materials = {
    cloth = { cell_size = 0.14, half_width = 1, density = 120, alpha = 0.9, damping_time = 3, friction = 1 },
    jelly = { cell_size = 0.1, half_width = 2, density = 120, frequency = 16, damping_time = 0.8, friction = 1 },
  },
  rigid_body = { { name = "frame", colour = "#2E5E8C", parts = parts } },
  soft_body = {
    { name = "sheet", shape = { kind = "box", size = { 2 * half, 0.1, 2 * half }, step = 0.07 }, material = "cloth", position = { 0, height, 0 }, colour = "#30363C" },
    { name = "ball", shape = { kind = "sphere", radius = 0.34 }, material = "jelly", position = { 0.05, 2.6, 0.03 }, colour = "#E0782C" },
    { name = "cube", shape = { kind = "rounded_box", size = { 0.45, 0.45, 0.45 } }, material = "jelly", position = { -0.6, 5.5, -0.1 }, colour = "#4FA35A" },
  },
  attach = attach,
}
