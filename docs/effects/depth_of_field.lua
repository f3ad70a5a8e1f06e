-- SPDX-License-Identifier: MIT
-- zoom: 440,200,480,270
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.depth_of_field { focus_distance = 4.5, aperture = 0.7, focal_length = 50, max_radius = 8 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
