-- SPDX-License-Identifier: MIT
-- Pyramids of the picture that is delivered. An effect that halves its source again and again reaches as far as the source has pixels; a
-- preview, which runs smaller (g.length_scale < 1), has fewer. So the levels are counted on the delivered picture, and those that are finer than
-- the preview are left out: there its own pixels stand for them.
local fx = require "afterglow"

local pyramid = {}

-- Width and height of the picture that is delivered, of which `source` is a preview; no side longer than images can be (1 line that stands for
-- 1080 would be).
function pyramid.delivered(g, source)
  if g.length_scale == 1 then return source.width, source.height end
  local function side(pixels) return math.min(math.max(1, math.floor(pixels / g.length_scale + 0.5)), 16384) end
  return side(source.width), side(source.height)
end

-- `image` at another size: halved while that leaves at least as much, then the mean over what is left; bilinear where it grows.
function pyramid.resized(g, image, width, height, name)
  local i = 0
  local function to(size, filter)
    image = g:filter { source = image, size = size, filter = filter, name = ("%s[%d]"):format(name, i) }
    i = i + 1
  end
  repeat
    local across, down = math.max(image.width // 2, 1), math.max(image.height // 2, 1)  -- a line of pixels stays one
    local halves = across >= width and down >= height and across + down < image.width + image.height
    if halves then to({ across, down }, fx.filters.bilinear()) end
  until not halves
  if image.width ~= width or image.height ~= height then
    to({ width, height }, fx.filters.area(image.width / width, image.height / height))
  end
  return image
end

-- The coarsest of `sizes` ({ width, height }, each at most the one before) that still has all pixels of a preview of this size.
function pyramid.start(sizes, width, height)
  local start = 1
  for i, size in ipairs(sizes) do
    if size[1] >= width and size[2] >= height then start = i end
  end
  return start
end

return pyramid
