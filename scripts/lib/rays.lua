-- SPDX-License-Identifier: MIT
-- Rays of light: each pixel of an image gives a share of its light to the pixels along a line, ever less of it. Three passes do so for each ray:
-- with n reads each, n³ pixels far, since every number up to n³ is a + n·b + n²·c (M. Kawase, "Frame Buffer Postprocessing Effects in DOUBLE-S.T.E.A.L",
-- GDC 2003). Beyond the picture there is no light.
local rays = {}

-- Size of a picture for rays: `lines` lines, so that rays are as wide and as bright a part of the picture at any size; half of what is delivered where that has less than two for each.
function rays.size(g, source, lines)
  local pyramids = require "lib.pyramid"
  local width, height = pyramids.delivered(g, source)
  if height > 2 * lines then
    width, height = math.max(width * lines // height, 1), lines
  else
    width, height = math.max(width // 2, 1), math.max(height // 2, 1)
  end
  return math.min(width, source.width), math.min(height, source.height)
end

-- The sum of `count` rays from each pixel of `image`, the first at `angle` degrees (0: to the right, 90: up). `length`: where a ray has a hundredth of the light that it
-- begins with, in pixels of `image`, by channel. All rays of a pixel together have its light.
function rays.of(g, image, count, angle, length)
  local longest = math.max(length[1], length[2], length[3], 1)
  local reads = math.max(2, math.min(math.ceil(longest ^ (1 / 3)), 16))
  local fall, gain = {}, {}
  for c = 1, 3 do
    fall[c] = math.log(100) / math.max(length[c], 1)
    gain[c] = (1 - math.exp(-fall[c])) / count
  end
  local sum = nil
  for ray = 1, count do
    local turn = math.rad(angle + 360 * (ray - 1) / count)
    local across, down = math.cos(turn), -math.sin(turn)
    if math.abs(across) < 1e-9 then across = 0 end  -- upright and flat rays stay so
    if math.abs(down) < 1e-9 then down = 0 end
    local ahead = image
    for stage = 0, 2 do
      local apart = reads ^ stage
      local keep = {}
      for c = 1, 3 do keep[c] = math.exp(-fall[c] * apart) end
      local last = stage == 2
      ahead = g:pass { shader = "glow/ray", source = ahead, sum = sum or ahead, add = last and sum ~= nil, size = image, reads = reads, apart = { across * apart, down * apart },
                       keep = keep, gain = last and gain or { 1, 1, 1 }, name = ("ray[%d][%d]"):format(ray - 1, stage) }
    end
    sum = ahead
  end
  return sum
end

return rays
