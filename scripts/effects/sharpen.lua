-- SPDX-License-Identifier: MIT
-- Sharpening that adapts to contrast: AMD FidelityFX CAS (T. Lottes, 2019), with the two knobs that ReShade's version gives it. Edges that
-- are strong already get little, so that halos stay small; light above display white gets none.
local fx = require "afterglow"

return fx.effect {
  name = "sharpen",
  doc = "Contrast-adaptive sharpening of fine detail; best after tone mapping.",
  at = "after_post_process", order = 120, space = "display",
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.6, doc = "Share of the sharpened picture. 0: none." },
    contrast = fx.float { min = 0, max = 1, default = 0, doc = "How much is sharpened: 0 CAS at its softest, 1 at its strongest." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  holds = { "black", "constant", "mirror", "turn_180", "turn_90", error = 1e-5 },
  build = function(g, s, source)
    -- Detail is finer than a preview's pixels; in a picture larger than the one that lengths belong to it is coarser.
    local finer, apart = math.min(1, g.length_scale), math.max(1, math.floor(g.length_scale + 0.5))
    return g:pass { shader = "sharpen/contrast_adaptive", source = source, amount = s.intensity * finer * finer, apart = apart, reach = apart, peak = 1 / (8 - 3 * s.contrast) }
  end,
}
