-- The report's figure 4.5: where the cells' corners go, what is within them goes. Three bodies of two cells each, held at all
-- twelve corners: at rest, with one upper edge moved, and turned.
local size, height = 1, 1.2
local bodies, drags = {}, {}

local function add(name, x, colour, moved)
  table.insert(bodies, {
    name = name,
    shape = { kind = "marked_cells", size = size, ball = { 0.2, 0.65, 0.5 } },
    cell_size = size,
    half_width = 1,
    alpha = 0.02,  -- so soft that the hands decide
    damping = 0.5,
    position = { x, height, 0 },
    colour = colour,
  })
  for column = -1, 1 do
    for row = -1, 1, 2 do
      for depth = -1, 1, 2 do
        local corner = { column * size, row * size / 2 }
        local goal = moved(column, row, corner)
        local z = depth * size / 2
        table.insert(drags, {
          begin = 0, ["end"] = 2, body = name,
          from = { x + corner[1], height + corner[2], z },
          to = { x + goal[1], height + goal[2], z },
        })
      end
    end
  end
end

add("at rest", -2.75, "#4FA35A", function(_, _, corner)
  return corner
end)
add("one edge moved", 0, "#C23B3B", function(column, row, corner)
  if column == -1 and row == 1 then
    return { corner[1] - 0.15, corner[2] + 0.6 }
  end
  return corner
end)
add("turned", 2.75, "#2E7FC2", function(_, _, corner)
  local cosine, sine = 0.866, 0.5
  return { cosine * corner[1] - sine * corner[2], sine * corner[1] + cosine * corner[2] }
end)

return {
  title = "what is within a cell goes with its corners (2008 report, figure 4.5)",
  world = { gravity = 0, frames = 180 },
  pictures = { 119 },
  camera = { eye = { 0, 1.5, 14 }, target = { 0, 1.25, 0 }, tan_half_fov_y = 0.165, near = 5, far = 30 },
  light = { toward = { -0.3, 0.6, 1 }, shadow_radius = 7 },
  soft_body = bodies,
  drag = drags,
}
