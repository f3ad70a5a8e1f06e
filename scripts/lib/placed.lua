-- SPDX-License-Identifier: MIT
-- A picture from a file in the room that it is to fill (math.md §56).
local pyramid = require "lib.pyramid"

local placed = {}

local function pixels(length) return math.max(math.floor(math.min(length, 1e8) + 0.5), 1) end

-- How large `picture` is in `room` ({ width, height }), by `factor`: as large as fits in ("contain"), so that nothing is left free ("cover"), in
-- the room's shape ("stretch"), or in its own size. Returns its size in pixels and the image, made smaller where it has more texels than that.
function placed.sized(g, picture, room, fit, factor)
  local across, down = room[1] / picture.width, room[2] / picture.height
  if fit == "contain" then
    across = math.min(across, down)
    down = across
  elseif fit == "cover" then
    across = math.max(across, down)
    down = across
  elseif fit ~= "stretch" then
    across, down = g.length_scale, g.length_scale
  end
  local size = { pixels(picture.width * across * factor), pixels(picture.height * down * factor) }
  return size, pyramid.resized(g, picture, math.min(size[1], picture.width), math.min(size[2], picture.height), "smaller")
end

-- The whole pixel of its upper left corner, at `position` (0 to 1 each way) of what it leaves of the room or goes beyond it.
function placed.corner(room, size, position, margin)
  local corner = {}
  for i = 1, 2 do corner[i] = math.floor(margin + position[i] * (room[i] - size[i]) + 0.5) end
  return corner
end

return placed
