-- 150 penguins of 160 particles each fall through bars and posts, as in the first figure of Rivers and James.
local boxes, obstacles, bodies = {}, {}, {}

-- Two layers of bars, crosswise, and posts between which the heap comes to rest.
for i = -2, 2 do
  table.insert(boxes, { size = { 7.6, 0.3, 0.3 }, position = { 0, 2.6, 1.5 * i }, colour = "#6F7F8F" })
  table.insert(boxes, { size = { 0.3, 0.3, 7.6 }, position = { 1.5 * i, 4.2, 0 }, colour = "#6F7F8F" })
end
for x = -1, 1 do
  for z = -1, 1 do
    table.insert(obstacles, {
      shape = { kind = "cylinder", radius = 0.25, height = 1 },
      position = { 2.2 * x, 0.5, 2.2 * z },
      colour = "#7F8F9F",
    })
  end
end

local colours = { "#2B3440", "#3D5A80", "#7A3B46", "#4F6D4A", "#5B4B73" }
for layer = 0, 5 do
  for row = 0, 4 do
    for column = 0, 4 do
      -- Every second layer stands in the gaps of the one below.
      local shift = 0.35 * (layer % 2)
      table.insert(bodies, {
        shape = { kind = "penguin", height = 0.9 },
        material = "penguin",
        position = { 1.3 * (column - 2) + shift, 5.4 + 1.15 * layer, 1.3 * (row - 2) + shift },
        colour = colours[(layer + row + column) % 5 + 1],
      })
    end
  end
end

return {
  title = "150 soft penguins of 160 particles fall through bars and posts",
  pictures = { 1, 60, 150 },
  world = { frames = 360, contacts = "surface", sleep = true },
  framework = { half_width = 4, height = 5.4, thickness = 0.3, front_opacity = 0.06 },
  camera = { eye = { 5.5, 10, 11.5 }, target = { 0, 4.9, 0 }, tan_half_fov_y = 0.45, near = 1, far = 60 },
  light = { shadow_radius = 9 },
  materials = { penguin = { cell_size = 0.15, half_width = 2, density = 250, alpha = 0.3, damping = 0.1 } },
  box = boxes,
  obstacle = obstacles,
  soft_body = bodies,
}
