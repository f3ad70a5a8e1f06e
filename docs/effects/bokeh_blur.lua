-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.bokeh_blur { radius = 7, blades = 6 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
