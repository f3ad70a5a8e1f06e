-- SPDX-License-Identifier: MIT
-- Letterbox: bars that leave a window of another shape. Its edges are exact to parts of a pixel, so that it moves smoothly when the shape is animated.
local fx = require "afterglow"

-- How much of n pixels is seen in a shape that has `length` of them. Less than half a pixel's bar is none ("1.78" means 16:9); up to one it grows faster, so that nothing jumps.
local function shown(n, length)
  local bars = n - length
  return n - (bars < 1 and math.max(2 * bars - 1, 0) or bars)
end

-- Where the window lies along an axis of n pixels of which it has `length`: its first and last whole pixel, and how much the ones beside them show,
-- then how much of those two the bars cover: as numbers of their own, for a bright bar is seen where it covers a millionth.
local function window(n, length, offset)
  local from = (n - length) * 0.5 * (1 + offset)
  local to = math.min(from + length, n)
  local first, last = math.ceil(from - 1e-9), math.floor(to + 1e-9) - 1
  local before, behind = first - from, to - last - 1
  if last < first - 1 then before, behind = to - from, 0 end  -- within a single pixel
  return { first, last }, { before, behind, 1 - before, 1 - behind }
end

return fx.effect {
  name = "letterbox",
  doc = "Bars above and below, or at the sides, for another shape of picture.",
  at = "after_post_process", order = 200, space = "display",
  settings = {
    aspect = fx.float { min = 0, max = 20, default = 2.39, doc = "Width over height of what stays: 2.39 scope, 1.85 flat, 1.78 television, 1.33 old film, 1 square. 0: no bars." },
    color = fx.color { default = { 0, 0, 0 }, doc = "The bars; display-linear." },
    offset = fx.float { min = -1, max = 1, default = 0, doc = "Where the window lies: -1 at the top or left, 0 in the middle, 1 at the bottom or right." },
  },
  active = function(s) return s.aspect > 0, "aspect is 0" end,
  holds = {
    "monotone", continuous = 1, error = 1e-6,
    black = { when = function(s) return s.color[1] == 0 and s.color[2] == 0 and s.color[3] == 0 end },
    mirror = { when = function(s) return s.offset == 0 end }, turn_180 = { when = function(s) return s.offset == 0 end },
    linear = { when = function(s) return s.color[1] == 0 and s.color[2] == 0 and s.color[3] == 0 end },
  },
  build = function(g, s, source)
    local across, down = source.width, source.height
    local shown_across, shown_down = shown(across, down * s.aspect), shown(down, across / s.aspect)
    if shown_across == across and shown_down == down then
      g:skip("the picture has this shape")
      return source
    end
    local columns, sides = window(across, shown_across, s.offset)
    local rows, edges = window(down, shown_down, s.offset)
    return g:pass { shader = "letterbox/bars", source = source, columns = columns, sides = sides, rows = rows, edges = edges, bars = s.color }
  end,
}
