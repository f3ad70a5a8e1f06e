-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.edge_detection { operator = "scharr", intensity = 3, color = { 1, 1, 1 }, background = { 0, 0, 0 }, background_opacity = 0.85 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
