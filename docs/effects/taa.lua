-- SPDX-License-Identifier: MIT
-- input: tests/images/neon_crop.exr --motion tests/images/neon_crop_motion.exr
local fx = require "afterglow"

return fx.stack {
  fx.taa { feedback = 0.9 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
