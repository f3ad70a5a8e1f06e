-- SPDX-License-Identifier: MIT
-- Pixelate: the picture in squares, each of the mean of its light. Means do not flicker as single samples would. Squares start at the upper
-- left corner; those at the right and lower edge may be cut. Their sides are whole numbers of 1/65536 pixel: the shaders count in those, so that
-- no square moves by rounding at the far end of a large picture.
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
    local block = math.floor(math.min(s.size, 16384) * 65536 + 0.5)  -- no picture is larger
    local function blocks_of(pixels) return (pixels * 65536 + block - 1) // block end
    local across, down = blocks_of(source.width), blocks_of(source.height)
    local rows = g:pass { shader = "pixelate/mean", source = source, size = { across, source.height }, block = block, down = false, name = "rows" }
    local blocks = g:pass { shader = "pixelate/mean", source = rows, size = { across, down }, block = block, down = true, name = "blocks" }
    return g:pass { shader = "pixelate/enlarge", source = blocks, picture = source, size = source, block = block }
  end,
}
