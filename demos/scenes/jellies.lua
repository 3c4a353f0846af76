-- A bowl of jellies: equal bodies of five stiffnesses, from red, as soft as custard, to violet, as firm as rubber.
-- Try: another `frequency` (Hz: how fast a jelly wobbles), or `softcell demo 3d --scene jellies` and stir them with the mouse.
local colours = { "#D8433B", "#E8902F", "#D9C23A", "#4FA35A", "#6A5ACD" }
local shapes = {
  { kind = "rounded_box", size = { 0.62, 0.5, 0.62 } },
  { kind = "sphere", radius = 0.32 },
  { kind = "torus", major = 0.3, minor = 0.14 },
}

local function times(a, b) -- quaternions { w, x, y, z }
  return { a[1] * b[1] - a[2] * b[2] - a[3] * b[3] - a[4] * b[4], a[1] * b[2] + a[2] * b[1] + a[3] * b[4] - a[4] * b[3],
           a[1] * b[3] - a[2] * b[4] + a[3] * b[1] + a[4] * b[2], a[1] * b[4] + a[2] * b[3] - a[3] * b[2] + a[4] * b[1] }
end

-- The bowl: rings of plates, each from (r, y) to the next in its profile, around a round foot.
local profile, plates = { { 0.5, 0.1 }, { 0.92, 0.26 }, { 1.2, 0.6 }, { 1.3, 1.0 } }, 28
local parts = { { kind = "cylinder", radius = 0.56, height = 0.12, position = { 0, 0.08, 0 } } }
for i = 1, #profile - 1 do
  local r0, y0, r1, y1 = profile[i][1], profile[i][2], profile[i + 1][1], profile[i + 1][2]
  local slope = math.atan(y1 - y0, r1 - r0)
  for k = 0, plates - 1 do
    local turn = 2 * math.pi * k / plates
    local q = times({ math.cos(turn / 2), 0, math.sin(turn / 2), 0 }, { math.cos(slope / 2), -math.sin(slope / 2), 0, 0 })
    local s, middle = math.sqrt(1 - q[1] * q[1]), (r0 + r1) / 2
    table.insert(parts, {
      kind = "box", size = { 2 * r1 * math.tan(math.pi / plates) + 0.01, 0.07, math.sqrt((r1 - r0) ^ 2 + (y1 - y0) ^ 2) + 0.03 },
      position = { middle * math.sin(turn), (y0 + y1) / 2, middle * math.cos(turn) },
      rotation = s > 1e-6 and { axis = { q[2] / s, q[3] / s, q[4] / s }, degrees = math.deg(2 * math.acos(q[1])) } or nil,
    })
  end
end

local bodies = {}
for i = 0, 9 do
  local turn = 2.4 * i
  table.insert(bodies, {
    name = "jelly " .. i + 1, shape = shapes[(i + i // 5) % 3 + 1], material = "jelly", frequency = 7 * 1.4 ^ (i % 5), colour = colours[i % 5 + 1],
    position = { 0.45 * math.cos(turn), 0.8 + 0.4 * i, 0.45 * math.sin(turn) },
  })
end

return {
  title = "a bowl of jellies of different stiffness",
  pictures = { 1, 100, 300 },
  world = { frames = 420, substeps = 3, friction = 0.6 },
  framework = { half_width = 2.2, height = 0.15, thickness = 0.1, front_opacity = 0.2 },
  camera = { eye = { 0.9, 3.6, 3.3 }, target = { 0, 0.62, 0 }, near = 0.4, far = 40 },
  light = { shadow_radius = 4 },
  materials = { jelly = { cell_size = 0.11, half_width = 2, density = 200, damping_time = 0.4, friction = 0.5 } },
  rigid_body = { { name = "bowl", colour = "#EFE9DC", parts = parts } },
  soft_body = bodies,
}
