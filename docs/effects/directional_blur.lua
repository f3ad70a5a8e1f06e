-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.directional_blur { distance = 20, angle = 20 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
