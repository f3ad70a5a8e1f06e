-- SPDX-License-Identifier: MIT
-- The same with fireflies faded and colours adjusted.
local fx = require "afterglow"
return fx.stack {
  name = "Scatter bloom, ACES and colour",
  fx.bloom { mode = "scattering", fade_fireflies = true },
  fx.tone_mapping { mode = "aces" },
  fx.color_adjustments { post_exposure = 0.3, contrast = 15, saturation = 10 },
}
