-- SPDX-License-Identifier: MIT
-- Radial blur: a zoom while the shutter is open. Each pixel is the mean of reads on its way to the centre.
local fx = require "afterglow"

return fx.effect {
  name = "radial_blur",
  doc = "Streaks towards a centre, as of a zoom or of speed.",
  at = "post_process", order = 82,
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.15, doc = "Share of the way to the centre that is smeared. 0: none." },
    samples = fx.int { min = 2, max = 128, default = 16, doc = "Reads on the way; few show as copies of bright spots." },
    center = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "The point that stays sharp: {0, 0} is the upper left corner, {1, 1} the lower right." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  -- Positions between pixels are rounded: the more, the larger the picture; so what is read at a hard edge is off by as much.
  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1,
            error = { fp32 = function(_, source) return 1e-3 + 2e-5 * math.max(source.width, source.height) end, fp16 = function(_, source) return 4e-3 + 2e-5 * math.max(source.width, source.height) end, up_to = 1 } },
  build = function(g, s, source)
    return g:pass { shader = "radial_blur/zoom", source = source, amount = s.intensity, samples = s.samples, center = s.center }
  end,
}
