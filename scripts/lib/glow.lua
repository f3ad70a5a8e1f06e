-- SPDX-License-Identifier: MIT
-- Wide glows: an image is halved again and again, and its levels are added with weights, one for each channel. Level i of the picture that is
-- delivered blurs like a Gaussian of about 0.76 · 2^i of its pixels: tents on the way down, cubic B-splines on the way up. All of it writes
-- two thirds of a picture, however wide the glow is.
local fx = require "afterglow"
local pyramids = require "lib.pyramid"

local glow = {}

-- Width and height of the whole image of which `source` is a preview of this scale.
local function whole(source, scale)
  return pyramids.delivered({ length_scale = scale }, source)
end

-- Deviation of level i, in pixels of the picture that is delivered.
local function sigma(i) return 0.76 * 2 ^ i end

-- How many levels a picture of this size has: the coarsest still has four pixels each way.
local function deepest(source, scale)
  local width, height = whole(source, scale)
  local n = 1
  while math.min(width, height) // 2 ^ (n + 1) >= 4 do n = n + 1 end
  return n
end

-- Weights of an exponential glow, e^(−r/radius): what a mixture of Gaussians takes of each deviation. `radii`: one for each channel, in pixels of the
-- image, which is `scale` of the whole. They sum up to 1.
function glow.exponential(source, scale, radii)
  local widest = math.max(radii[1], radii[2], radii[3]) / scale
  local n = 1
  while n < deepest(source, scale) and sigma(n) < 3 * widest do n = n + 1 end
  local weights, sum = {}, { 0, 0, 0 }
  for i = 1, n do
    weights[i] = {}
    for c = 1, 3 do
      local q = sigma(i) / math.max(radii[c] / scale, 0.5)
      weights[i][c] = q ^ 3 * math.exp(-0.5 * q * q)
      sum[c] = sum[c] + weights[i][c]
    end
  end
  for i = 1, n do
    for c = 1, 3 do weights[i][c] = weights[i][c] / sum[c] end
  end
  return weights
end

-- Weights of a glow that falls with the square of the distance up to `extent` pixels of the image: each doubling of the distance holds
-- as much light as the one before.
function glow.fog(source, scale, extent)
  local weights, sum = {}, 0
  for i = 1, deepest(source, scale) do
    local q = sigma(i) / math.max(extent / scale, 0.5)
    local w = math.exp(-0.5 * q * q)
    if i > 1 and w < 1e-3 then break end
    weights[i], sum = { w, w, w }, sum + w
  end
  for _, w in ipairs(weights) do
    for c = 1, 3 do w[c] = w[c] / sum end
  end
  return weights
end

-- The glow at the size of `source`, which is `scale` of the whole image (g.length_scale of the picture). `light(width, height)` makes the light that glows at
-- a size: half of the source's, or what a preview begins with.
function glow.of(g, source, scale, weights, light)
  local width, height = whole(source, scale)
  local sizes = {}
  for i = 1, #weights do
    width, height = math.max(width // 2, 1), math.max(height // 2, 1)
    sizes[i] = { width, height }
  end
  local start = scale < 1 and pyramids.start(sizes, source.width, source.height) or 1
  local image = light(sizes[start][1], sizes[start][2])
  local levels = { [start] = image }
  for i = start + 1, #sizes do
    levels[i] = g:filter { source = levels[i - 1], size = sizes[i], filter = fx.filters.tent(), name = ("down[%d]"):format(i - 2) }
  end
  -- Levels that are finer than a preview look like its own pixels.
  local first = { 0, 0, 0 }
  for i = 1, start do
    for c = 1, 3 do first[c] = first[c] + weights[i][c] end
  end
  image = nil
  for i = #sizes, start, -1 do
    local weight = i == start and first or weights[i]
    if image then
      image = g:filter { source = image, size = levels[i], filter = fx.filters.bspline(), name = ("up[%d]"):format(i - 1) }
      image = g:pass { shader = "glow/add", source = image, level = levels[i], weight = weight, name = ("sum[%d]"):format(i - 1) }
    else
      image = g:pass { shader = "glow/weigh", source = levels[i], weight = weight, name = ("sum[%d]"):format(i - 1) }
    end
  end
  return g:filter { source = image, size = source, filter = fx.filters.bspline(), name = "glow" }
end

-- What of `source` is brighter than the threshold, at another size; no light counts for more than the limit (none: nil). It is taken of each pixel before any mean:
-- a mean of a lamp and the night around it depends on where between pixels the lamp lies, and lamps that move would blink. `own`: it goes through the layers of a film, and so much of it keeps its own colour; nil: light stays as it is.
function glow.bright(g, source, width, height, threshold, limit, own)
  local across, down = math.max(source.width // 2, 1), math.max(source.height // 2, 1)
  local halves = across >= width and down >= height and across + down < source.width + source.height
  local image = g:pass { shader = halves and "glow/bright_half" or "glow/bright", source = source, size = halves and { across, down } or nil,
                         reach = halves and 2 or nil, threshold = threshold, limit = limit or 1e30, film = own ~= nil and own < 1, own = own or 1, name = "bright" }
  return pyramids.resized(g, image, width, height, "scaled")
end

return glow
