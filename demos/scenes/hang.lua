-- A swing hangs on four ropes, and two cubes of jelly ride on it: the ropes carry both, and are never longer than they are.
-- On the left a ball hangs on a ball; on the right a shelf of jelly is welded to a post and carries a box.
-- Try: half the `alpha` of `jelly`, and the plank sags; `break_force = 60` in `rope`, and the swing tears when they
-- land. In the window (`softcell demo 3d --scene hang`) take the plank by the hand and swing it.
local jelly = { cell_size = 0.12, half_width = 2, density = 120, alpha = 0.6, damping = 0.1, friction = 1 }
local attach = {}

-- A rope from a patch of a body straight up, or to `point`.
local function rope(body, at, point, to)
  table.insert(attach, { body = body, rigid = not to and "frame" or nil, to = to, kind = "rope", at = at, radius = 0.15,
                         point = not to and point or nil, other_at = to and point or nil })
end

for _, x in ipairs { -0.4, 0.7 } do
  for _, z in ipairs { -0.24, 0.24 } do rope("plank", { x, 1, z }, { x, 2.56, 0.9 * z }) end
end
rope("upper ball", { -1.2, 1.88, 0 }, { -1.2, 2.56, 0 })
rope("lower ball", { -0.9, 1.0, 0.2 }, { -1.2, 1.32, 0 }, "upper ball")
table.insert(attach, { body = "shelf", rigid = "frame", at = { 1.8, 1, 0 }, radius = 0.3 })

return {
  title = "bodies hang on ropes and welds, and carry others",
  pictures = { 1, 90, 240 },
  world = { frames = 360, substeps = 4 },
  framework = { half_width = 2.6, height = 0.2, thickness = 0.15, front_opacity = 0.2 },
  light = { shadow_radius = 4.5 },
  camera = { eye = { 1.2, 1.9, 5.4 }, target = { 0, 1.28, 0 }, near = 0.5, far = 40 },
  materials = { jelly = jelly },
  rigid_body = { {
    name = "frame",
    colour = "#7A5B3C",
    parts = {
      { kind = "box", size = { 0.2, 2.6, 0.2 }, position = { -1.9, 1.3, 0 } },
      { kind = "box", size = { 0.2, 2.6, 0.2 }, position = { 1.9, 1.3, 0 } },
      { kind = "box", size = { 4.4, 0.18, 0.6 }, position = { 0, 2.65, 0 } },
    },
  } },
  soft_body = {
    { name = "plank", shape = { kind = "box", size = { 1.3, 0.2, 0.7 } }, material = "jelly", position = { 0.15, 0.9, 0 },
      colour = "#D2A35A" },
    { name = "cube", shape = { kind = "rounded_box", size = { 0.5, 0.5, 0.5 } }, material = "jelly", position = { 0.15, 1.35, 0 },
      rotation = { degrees = -20 }, colour = "#2E7FC2" },
    { name = "small cube", shape = { kind = "rounded_box", size = { 0.34, 0.34, 0.34 } }, material = "jelly", position = { 0.15, 1.85, 0 },
      rotation = { degrees = 15 }, colour = "#D98E73" },
    { name = "upper ball", shape = { kind = "sphere", radius = 0.28 }, material = "jelly", position = { -1.2, 1.6, 0 },
      colour = "#C23B3B" },
    { name = "lower ball", shape = { kind = "sphere", radius = 0.2 }, material = "jelly", position = { -0.8, 0.85, 0.2 },
      colour = "#E0782C" },
    { name = "shelf", shape = { kind = "box", size = { 0.7, 0.24, 0.5 } }, material = "jelly", position = { 1.45, 1, 0 },
      colour = "#4FA35A" },
  },
  box = { { size = { 0.28, 0.28, 0.28 }, mass = 2, position = { 1.35, 1.6, 0 }, rotation = { degrees = 25 }, colour = "#C9A227" } },
  attach = attach,
}
