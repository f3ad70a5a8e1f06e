-- SPDX-License-Identifier: MIT
-- Five effects that read only their own pixel; the looks pixel_1 to pixel_5 hold one each.
local fx = require "afterglow"
return fx.stack {
  name = "Five pixel effects",
  fx.color_blit { intensity = 1.5, at = "before_post_process", order = 1 },
  fx.tone_mapping { mode = "neutral", order = 1 },
  fx.color_adjustments { post_exposure = 0.3, at = "post_process", order = 2 },
  fx.tone_mapping { mode = "reinhard", order = 3 },
  fx.color_adjustments { saturation = 10 },
}
