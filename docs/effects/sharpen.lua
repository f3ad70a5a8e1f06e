-- SPDX-License-Identifier: MIT
-- zoom: 240,90,480,270
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.sharpen { intensity = 1, contrast = 1 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
