-- SPDX-License-Identifier: MIT
-- Soft edges for mattes: a Gaussian over the mask.
local fx = require "afterglow"

local kMost = 6  -- standard deviation, in texels, above which a smaller image does
local kHalving = { { -1.5, 0.125 }, { -0.5, 0.375 }, { 0.5, 0.375 }, { 1.5, 0.125 } }

-- Cut at three standard deviations; the weights sum to 1.
local function gaussian(deviation)
  local reach, sum, taps = math.ceil(3 * deviation), 0, {}
  for i = -reach, reach do
    local weight = math.exp(-0.5 * (i / deviation) ^ 2)
    sum = sum + weight
    taps[#taps + 1] = { i, weight }
  end
  for _, tap in ipairs(taps) do tap[2] = tap[2] / sum end
  return taps
end

local feather = {}

feather.setting = fx.float { min = 0, max = 200, default = 0, unit = "px",
  doc = "Softens the mask: the standard deviation of a Gaussian over it. 0: as it is." }

-- `mask` with its edges softened over `deviation` pixels. Wide ones are made of a smaller mask; what making it smaller and larger again blurs
-- counts.
function feather.of(g, mask, deviation)
  if deviation < 0.1 then return mask end
  local whole, variance, scale = mask, deviation ^ 2, 1
  while deviation / scale > kMost do
    mask = g:filter {
      source = mask, size = { math.max(mask.width // 2, 1), math.max(mask.height // 2, 1) },
      filter = { x = kHalving, y = kHalving }, channels = 1, name = ("smaller[%d]"):format(scale),
    }
    variance = variance - 0.75 * scale ^ 2
    scale = 2 * scale
  end
  if scale > 1 then variance = variance - scale ^ 2 / 3 end  -- of the B-spline
  local taps = gaussian(math.sqrt(variance) / scale)
  mask = g:filter { source = mask, filter = { interpolation = "nearest", x = taps, y = taps }, channels = 1, name = "feather" }
  if scale == 1 then return mask end
  return g:filter { source = mask, size = whole, filter = fx.filters.bspline(), channels = 1, name = "larger" }
end

return feather
