-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/alley_move.exr --size 960x540 --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.motion_blur { shutter_angle = 720, motion_scale = { 2, 2 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
