-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.color_adjustments { post_exposure = 1.5, contrast = 30, saturation = 40, hue_shift = 30 },
  fx.tone_mapping { mode = "neutral" },
}
