-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.box_bloom { threshold = 3, blur_iterations = 3, pattern = "box" },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
