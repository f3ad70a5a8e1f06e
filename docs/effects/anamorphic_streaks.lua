-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.anamorphic_streaks { threshold = 8, stretch = 0.7, intensity = 0.15 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
