-- The man of the 2D demo: 132 particles. He is drawn from rectangles of cells, and is as wide with stretched arms as he is high.
local cells = {}

local function add(left, bottom, width, height)
  for x = left, left + width - 1 do
    for y = bottom, bottom + height - 1 do
      table.insert(cells, { x, y })
    end
  end
end

local leg, torso, shoulder = 7, 4, 9
for _, side in ipairs({ 0, 1 }) do
  add(5 + 4 * side, 0, 2, leg)
  add(11 * side, shoulder, 5, 2) -- an arm
end
add(5, leg, 6, torso)
add(7, leg + torso, 2, 1)     -- the neck
add(6, leg + torso + 1, 4, 4) -- the head

return { cells = cells }
