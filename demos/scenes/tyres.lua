-- A car drives over bumps on four soft tyres, which are welded to the rims of its wheels; motors turn the rear wheels.
-- Try: `alpha` of `rubber`, from flat tyres (0.05) to hard ones (0.9); `speed` of the motors; higher bumps; `mass` of the body.
local rubber = { cell_size = 0.085, half_width = 2, density = 120, alpha = 0.5, damping = 0.15, friction = 1.3 }
local start, axle, radius = -2.7, 0.46, 0.32 -- metres: of the car along the road, of its axles above it, of a tyre's ring
local bodies, tyres, welds, joints = {}, {}, {}, {}

table.insert(bodies, {
  name = "chassis", mass = 60, position = { start, axle, 0 },
  parts = {
    { kind = "box", size = { 1.9, 0.22, 0.62 }, position = { 0, 0.1, 0 }, colour = "#C23B3B" },
    { kind = "box", size = { 0.95, 0.34, 0.6 }, position = { -0.15, 0.36, 0 }, colour = "#C23B3B" },
    { kind = "box", size = { 0.85, 0.2, 0.62 }, position = { -0.15, 0.38, 0 }, colour = "#BFD7E3" },
    { kind = "box", size = { 0.97, 0.05, 0.62 }, position = { -0.15, 0.54, 0 }, colour = "#8A2B2C" },
    { kind = "sphere", radius = 0.07, position = { 0.93, 0.14, 0.2 }, colour = "#FFF3C4" },
    { kind = "sphere", radius = 0.07, position = { 0.93, 0.14, -0.2 }, colour = "#FFF3C4" },
  },
})
for _, x in ipairs { -0.62, 0.62 } do
  for _, z in ipairs { -0.5, 0.5 } do
    local name = (x < 0 and "rear" or "front") .. (z < 0 and " right" or " left")
    local hub = { start + x, axle, z }
    table.insert(bodies, {
      name = name, mass = 10, position = hub, rotation = { axis = { 1, 0, 0 }, degrees = 90 },
      parts = {
        { kind = "cylinder", radius = 0.24, height = 0.12, colour = "#C8CDD2" },
        { kind = "cylinder", radius = 0.07, height = 0.2, colour = "#6F7F8F" },
        { kind = "box", size = { 0.4, 0.15, 0.07 }, colour = "#8B949E" },
        { kind = "box", size = { 0.07, 0.15, 0.4 }, colour = "#8B949E" },
      },
    })
    table.insert(tyres, { name = name .. " tyre", shape = { kind = "torus", major = radius, minor = 0.13 }, material = "rubber",
                          position = hub, rotation = { axis = { 1, 0, 0 }, degrees = 90 }, colour = "#2B2F33" })
    table.insert(welds, { body = name .. " tyre", rigid = name, at = hub, radius = 0.27 })
    table.insert(joints, { a = "chassis", b = name, point = hub, axis = { 0, 0, 1 }, speed = -5, torque = x < 0 and 120 or 0 })
  end
end

-- Bumps across the road, each half buried.
local bumps = { { -1.0, 0.16 }, { 0.2, 0.22 }, { 0.95, 0.16 }, { 1.9, 0.24 } }
for i, bump in ipairs(bumps) do
  table.insert(bodies, { name = "bump " .. i, position = { bump[1], -0.06, (i % 2) * 0.1 }, rotation = { axis = { 1, 0, 0 }, degrees = 90 },
                         shape = { kind = "cylinder", radius = bump[2], height = 1.5 }, colour = "#D9A441" })
end

return {
  title = "a car on soft tyres drives over bumps",
  pictures = { 1, 120, 260 },
  world = { frames = 360, substeps = 4, friction = 1 },
  framework = { half_width = 3.7, height = 0.5, thickness = 0.2, front_opacity = 0.2 },
  light = { shadow_radius = 6 },
  camera = { eye = { 1.0, 2.0, 6.6 }, target = { 0.05, 0.4, 0 }, tan_half_fov_y = 0.31, near = 0.5, far = 40 },
  materials = { rubber = rubber },
  rigid_body = bodies, joint = joints, soft_body = tyres, attach = welds,
}
