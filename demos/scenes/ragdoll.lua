-- A ragdoll of jelly falls down the stairs. Its limbs are bodies of their own, held together by hinges and welds.
-- Try: `kind = "weld"` for elbows and knees; the height from which it falls (`at`); softer limbs (`frequency`).
local at = { -1.5, 2.25, 0 } -- metres: where the middle of its chest is
local skin, shirt, trousers = "#E8B48C", "#C23B3B", "#2E5E8C"
local bodies, attach = {}, {}

local function part(name, shape, x, y, z, colour)
  table.insert(bodies, { name = name, shape = shape, material = "flesh", position = { at[1] + x, at[2] + y, at[3] + z }, colour = colour })
end
local function join(a, b, kind, x, y, z, radius, axis)
  table.insert(attach, { body = a, to = b, kind = kind, at = { at[1] + x, at[2] + y, at[3] + z }, radius = radius, axis = axis,
                         point = kind == "hinge" and { at[1] + x, at[2] + y, at[3] + z } or nil })
end

-- It looks along x, and stands.
part("chest", { kind = "rounded_box", size = { 0.3, 0.56, 0.46 } }, 0, 0, 0, shirt)
part("hips", { kind = "rounded_box", size = { 0.28, 0.28, 0.42 } }, 0, -0.36, 0, trousers)
part("head", { kind = "sphere", radius = 0.19 }, 0.01, 0.44, 0, skin)
join("hips", "chest", "weld", 0, -0.25, 0, 0.16)
join("head", "chest", "weld", 0, 0.27, 0, 0.14)
for side, z in ipairs { -1, 1 } do
  local name = side == 1 and "right " or "left "
  part(name .. "upper arm", { kind = "capsule", radius = 0.08, height = 0.42, segments = 24 }, 0, 0.03, 0.32 * z, shirt)
  part(name .. "forearm", { kind = "capsule", radius = 0.07, height = 0.42, segments = 24 }, 0, -0.33, 0.32 * z, skin)
  part(name .. "thigh", { kind = "capsule", radius = 0.1, height = 0.5, segments = 24 }, 0, -0.68, 0.12 * z, trousers)
  part(name .. "shin", { kind = "capsule", radius = 0.085, height = 0.5, segments = 24 }, 0, -1.12, 0.12 * z, skin)
  join(name .. "upper arm", "chest", "hinge", 0, 0.16, 0.26 * z, 0.13, { 0, 0, 1 })
  join(name .. "forearm", name .. "upper arm", "hinge", 0, -0.15, 0.32 * z, 0.1, { 0, 0, 1 })
  join(name .. "thigh", "hips", "hinge", 0, -0.46, 0.12 * z, 0.13, { 0, 0, 1 })
  join(name .. "shin", name .. "thigh", "hinge", 0, -0.9, 0.12 * z, 0.11, { 0, 0, 1 })
end

local stairs = {}
for i = 0, 4 do
  table.insert(stairs, { size = { 0.45, 0.22 * (5 - i), 1.8 }, position = { -1.9 + 0.45 * i, 0.11 * (5 - i), 0 }, colour = i % 2 == 0 and "#A9743F" or "#B98450" })
end

return {
  title = "a ragdoll of jelly falls down the stairs",
  pictures = { 1, 60, 150 },
  world = { frames = 360, substeps = 4 },
  framework = { half_width = 2.6, height = 0.2, thickness = 0.15, front_opacity = 0.2 },
  light = { shadow_radius = 5 },
  camera = { eye = { 1.7, 2.3, 4.1 }, target = { -0.55, 1.15, 0 }, near = 0.5, far = 40 },
  materials = { flesh = { cell_size = 0.075, half_width = 2, density = 150, frequency = 14, damping_time = 0.1, friction = 0.7 } },
  box = stairs, soft_body = bodies, attach = attach,
  impulse = { { time = 0.05, body = "chest", velocity = { 1.6, 0, 0.3 } } },
}
