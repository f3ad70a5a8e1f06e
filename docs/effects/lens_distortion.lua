-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.lens_distortion { intensity = 0.4, scale = 1.05 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
