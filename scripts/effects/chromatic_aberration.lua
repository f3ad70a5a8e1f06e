-- SPDX-License-Identifier: MIT
-- Chromatic aberration: a lens that magnifies colours differently. Along a line towards the centre red is read first and blue last; length
-- and growth with the cube of the distance are Unity's (UberPost, URP), whose three reads are `samples = 3`. More make a spectrum of it,
-- as HDRP does with a lookup table, without gaps: each pixel of a fringe is read. math.md §38.
local fx = require "afterglow"

return fx.effect {
  name = "chromatic_aberration",
  doc = "Colour fringes that grow towards the corners.",
  at = "post_process", order = 140,
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.1, doc = "Length of the fringes; 1 is a thirtieth of the picture at the middle of its sides. 0: none." },
    samples = fx.int { min = 3, max = 24, default = 6, doc = "3: three sharp pictures. 4 and more, all alike: a spectrum, even however long the fringes are." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  -- Positions between pixels are rounded: the more, the larger the picture; so what is read at a hard edge is off by as much.
  -- A pixel is the sum of a fringe: of up to a thirtieth of the picture's longer side, each rounded.
  holds = { "black", constant = { within = function(_, source) return 1e-5 * math.max(1, math.max(source.width, source.height) / 4096) end }, "bounded", "monotone", "linear", continuous = 1,
            error = { fp32 = function(_, source) return 1e-3 + 2e-5 * math.max(source.width, source.height) end, fp16 = function(_, source) return 4e-3 + 2e-5 * math.max(source.width, source.height) end, up_to = 1 } },
  build = function(g, s, source)
    return g:pass { shader = "chromatic_aberration/spectrum", source = source, amount = s.intensity * 0.05 * 2 / 3, three = s.samples == 3 }
  end,
}
