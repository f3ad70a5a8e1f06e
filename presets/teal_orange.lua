-- SPDX-License-Identifier: MIT
-- Teal and orange: a filmic tone curve, a soft glow, and a colourist's table (assets/luts).
local fx = require "afterglow"

return fx.stack {
  name = "Teal and orange",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 1.0, intensity = 0.12, fade_fireflies = true, edges = "mirror" },
  fx.vignette { intensity = 0.3 },
  fx.color_adjustments { post_exposure = 0.6, contrast = 16 },
  fx.tone_mapping { mode = "neutral" },
  fx.lut { file = "luts/teal_orange.cube", intensity = 0.9 },
}
