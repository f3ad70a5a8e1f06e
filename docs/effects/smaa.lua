-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/alley_shot.####.exr --frames 8 --set color_adjustments.post_exposure=0.3
-- zoom: 0,0,240,135
local fx = require "afterglow"

return fx.stack {
  fx.smaa { threshold = 0.05 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
