-- SPDX-License-Identifier: MIT
-- zoom: 300,90,240,135
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.film_grain { intensity = 0.8, size = 1.5 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
