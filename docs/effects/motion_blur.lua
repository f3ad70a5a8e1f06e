-- SPDX-License-Identifier: MIT
-- input: tests/images/neon_crop.exr --motion tests/images/neon_crop_motion.exr
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.motion_blur { shutter_angle = 300, samples = 48 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
