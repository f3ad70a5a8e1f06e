-- SPDX-License-Identifier: MIT
-- Directional blur: a camera that moves while the shutter is open. The mean of the picture along a line, read once for each column that it
-- crosses (each row, where it is steep) and interpolated between them: weights are integrals, so that no length differs from the next by more
-- than lengths do. A long line is n pieces laid end to end: the mean of n reads, a piece apart, blurred along a piece, so that a hundred reads do
-- for a thousand pixels.
local fx = require "afterglow"

local kWhole = 35  -- columns up to which one pass reads all
local kLongest = 127 * 129  -- as many columns as a picture has, and as many reads as a filter has

-- The mean along a line of `length` columns; (x, y) is the step from column to column. What a column counts falls from 1 at its place to 0 at
-- its neighbours', so that it is a straight line on each side.
local function mean(length, x, y)
  local taps, half = {}, length / 2
  if half < 1e-6 then return { taps = { { 0, 0, 1 } } } end
  for i = -math.ceil(half), math.ceil(half) do
    local weight = 0
    for side = i - 1, i do
      local from, to = math.max(side, -half), math.min(side + 1, half)
      if from < to then weight = weight + (to - from) * (1 - math.abs((from + to) / 2 - i)) end
    end
    taps[#taps + 1] = { i * x, i * y, weight / length }
  end
  return { taps = taps }
end

-- The mean of `n` reads, `spacing` columns apart, each of the two columns that it lies between.
local function pieces(n, spacing, x, y)
  local taps = {}
  for i = (1 - n) // 2, n // 2 do
    local column = math.floor(i * spacing)
    local beyond = i * spacing - column
    taps[#taps + 1] = { column * x, column * y, (1 - beyond) / n }
    taps[#taps + 1] = { (column + 1) * x, (column + 1) * y, beyond / n }
  end
  return { taps = taps }
end

return fx.effect {
  name = "directional_blur",
  doc = "Smears the picture along one direction, as a moving camera does.",
  at = "post_process", order = 84,
  settings = {
    distance = fx.float { min = 0, max = 1000, default = 24, unit = "px", doc = "Length of the smear. 0: none." },
    angle = fx.float { min = -180, max = 180, default = 0, unit = "degrees", doc = "Direction: 0 across, 90 up and down, 45 rising to the right." },
  },
  active = function(s) return s.distance > 0, "distance is 0" end,
  holds = { "black", "constant", "bounded", "monotone", "linear", "turn_180", continuous = 1, error = { fp32 = 5e-4, fp16 = 4e-3, up_to = 50 } },
  build = function(g, s, source)
    local radians = s.angle * math.pi / 180
    local x, y = math.cos(radians), -math.sin(radians)
    local across = math.max(math.abs(x), math.abs(y))
    x, y = x / across, y / across
    local length = math.min(s.distance * across, kLongest)
    -- An odd number, the next wherever both divide the length into whole columns, and so give the same: 63 is 7·9 and 9·7.
    local n = length > kWhole and 2 * math.ceil((math.sqrt(1 + length) - 2) / 2) + 1 or 1
    -- The far ones first: what lies beyond the picture is then its own last pixel, not a blurred one, but for half a piece.
    local image = source
    if n > 1 then image = g:filter { source = image, filter = pieces(n, length / n, x, y), name = "far" } end
    image = g:filter { source = image, filter = mean(length / n, x, y), name = "near" }
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
