-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.smaa { threshold = 0.05 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
