-- SPDX-License-Identifier: MIT
-- Colour blit: green light alone. The smallest effect there is: one setting, one pass; a pattern to copy.
-- After Unity's URP example of a full-screen blit.
local fx = require "afterglow"

return fx.effect {
  name = "color_blit",
  doc = "The teaching example: the smallest effect there is, to copy from. Leaves green light alone, scaled.",
  at = "after_opaque_and_sky", order = 0,
  settings = {
    intensity = fx.float { min = 0, max = 2, default = 0, doc = "Factor of green; 0: the effect does not run." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  holds = { "black", "monotone", "linear", "constant", "mirror", "turn_180", "turn_90", shift = 1, continuous = 2, error = 1e-5 },
  build = function(g, s, source) return g:pass { shader = "color_blit/green", source = source, intensity = s.intensity } end,
}
