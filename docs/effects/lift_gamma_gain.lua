-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.lift_gamma_gain { lift_offset = 0.01, gamma = { 0.9, 1, 1.15 }, gamma_offset = 0.2, gain = { 1.15, 1, 0.85 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
