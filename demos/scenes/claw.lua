-- A claw machine: the claw sinks among the toys, closes, and carries what it has caught to the hole. Will it hold?
-- Try: where the claw goes down (`x`, `z`), how far it closes (`closed`, degrees), its `friction`; other toys.
local x, z, closed, open = 0.02, 0.05, -16, -44
local top, low, hole = 2.35, 1.3, -1.55 -- metres: height of the hub, above the toys and among them; where the hole is

-- What the claw does: seconds, place of the hub, angle of its fingers.
local plan = {
  { 0.0, 0, top, 0, closed }, { 0.8, x, top, z, closed }, { 1.3, x, top, z, open }, { 2.9, x, low, z, open },
  { 4.2, x, low, z, closed }, { 5.4, x, top, z, closed }, { 6.8, hole, top, 0, closed }, { 7.3, hole, top, 0, open },
}
local function motion(axis)
  local stops = {}
  for _, step in ipairs(plan) do
    table.insert(stops, { time = step[1], offset = { step[2], step[3] - top, step[4] }, degrees = axis and step[5] - closed or 0 })
  end
  return { axis = axis, stops = stops }
end

local rigid = { {
  name = "hub", motion = motion(), colour = "#8B949E",
  position = { 0, top, 0 },
  parts = {
    { kind = "cylinder", radius = 0.16, height = 0.16, position = { 0, 0.06, 0 } },
    { kind = "cylinder", radius = 0.03, height = 2.4, position = { 0, 1.3, 0 }, colour = "#3B444D" },
  },
} }
for finger = 0, 2 do -- each turns about an axis across the way to it, and is bent inwards at its middle
  local turn = 2 * math.pi * finger / 3 + 0.5
  local c, s = math.cos(turn), math.sin(turn)
  local function part(x, y, height, lean) -- in the finger's own frame, where x is outwards
    return { kind = "capsule", radius = 0.07, height = height, position = { x, y, 0 }, rotation = { axis = { 0, 0, 1 }, degrees = lean }, colour = "#C8CDD2" }
  end
  table.insert(rigid, {
    name = "finger " .. finger + 1, friction = 1.6, motion = motion({ s, 0, -c }), position = { 0.13 * c, top, 0.13 * s },
    rotation = { axis = { 0, 1, 0 }, degrees = -math.deg(turn) },
    parts = { part(0.12, -0.14, 0.48, 42), part(0.2, -0.46, 0.46, -22), part(0.07, -0.67, 0.26, -65) },
  })
end

-- The case: a floor for the toys beside the hole, glass around it.
local function wall(sx, sy, sz, px, py, pz, colour, opacity)
  table.insert(rigid, { name = "wall " .. #rigid, shape = { kind = "box", size = { sx, sy, sz } }, position = { px, py, pz }, colour = colour, opacity = opacity })
end
wall(2.3, 0.5, 2.2, 0.15, 0.25, 0, "#8C3A5B")
wall(0.06, 0.55, 2.2, -1.03, 0.72, 0, "#D9A441")
wall(2.36, 0.55, 0.06, 0.15, 0.72, 1.1, "#BFD7E3", 0.25)
wall(2.36, 0.55, 0.06, 0.15, 0.72, -1.1, "#D9A441")
wall(0.06, 0.55, 2.2, 1.33, 0.72, 0, "#D9A441")

local shapes = { { kind = "sphere", radius = 0.24 }, { kind = "capsule", radius = 0.16, height = 0.55 }, { kind = "rounded_box", size = { 0.42, 0.42, 0.42 } } }
local colours = { "#2E7FC2", "#C23B3B", "#4FA35A", "#E0782C", "#6A5ACD", "#C9A227" }
local toys = {}
for i = 0, 13 do
  local is_ball = i % 4 == 2 -- painted ones
  table.insert(toys, { name = "toy " .. i + 1, shape = not is_ball and shapes[i % 3 + 1] or nil, mesh = is_ball and "beach_ball.glb" or nil,
                       longest_side = is_ball and 0.5 or nil, colour = not is_ball and colours[i % 6 + 1] or nil, material = "plush", rotation = { degrees = 50 * i },
                       position = { 0.52 * (i % 4) - 0.62, 0.85 + 0.5 * (i // 8), 0.55 * (i // 4 % 2) - 0.28 } })
end

return {
  title = "a claw machine",
  pictures = { 1, 200, 330 },
  world = { frames = 500, substeps = 4, friction = 0.7 },
  framework = { half_width = 2.4, height = 0.15, thickness = 0.12, front_opacity = 0.2 },
  light = { shadow_radius = 4.5 },
  camera = { eye = { 0.7, 2.5, 4.6 }, target = { -0.2, 1.2, 0 }, near = 0.5, far = 40 },
  materials = { plush = { cell_size = 0.085, half_width = 2, density = 80, frequency = 30, damping_time = 0.1, friction = 1 } },
  rigid_body = rigid, soft_body = toys,
}
