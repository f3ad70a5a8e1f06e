-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.vignette { intensity = 0.45, smoothness = 0.5 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
