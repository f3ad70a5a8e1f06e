-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.radial_blur { intensity = 0.25, samples = 24, center = { 0.4, 0.4 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
