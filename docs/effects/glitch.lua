-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  reference_height = 180,  -- lengths are those of a picture of this height
  fx.glitch { scan_line_jitter = 0.65, line_height = 3, rgb_split = 0.4 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
