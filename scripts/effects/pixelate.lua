-- SPDX-License-Identifier: MIT
-- Pixelate: the picture in squares, each of the mean of its light. Means do not flicker as single samples would. Squares start at the upper
-- left corner; those at the right and lower edge may be cut.
local fx = require "afterglow"

return fx.effect {
  name = "pixelate",
  doc = "Large square pixels, each the mean of what it covers.",
  at = "after_post_process", order = 130,
  settings = {
    size = fx.float { min = 1, max = 1024, default = 8, unit = "px", doc = "Side of a square. 1: the picture as it is." },
  },
  active = function(s) return s.size > 1, "size is 1" end,
  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1, error = 1e-5 },
  build = function(g, s, source)
    local across, down = math.ceil(source.width / s.size), math.ceil(source.height / s.size)
    local rows = g:pass { shader = "pixelate/mean", source = source, size = { across, source.height }, block = s.size, down = false, name = "rows" }
    local blocks = g:pass { shader = "pixelate/mean", source = rows, size = { across, down }, block = s.size, down = true, name = "blocks" }
    return g:pass { shader = "pixelate/enlarge", source = blocks, picture = source, size = source, block = s.size }
  end,
}
