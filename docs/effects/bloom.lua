-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.bloom { mode = "scattering", intensity = 0.2, fade_fireflies = true },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
