-- SPDX-License-Identifier: MIT
-- zoom: 240,200,480,270
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.outline { combine = "max", fade_distance = 40, depth_scale = 4, normal_scale = 0.7, contrast = 5 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
