-- SPDX-License-Identifier: MIT
-- Exteriors and interiors by day: what an old lens and print film do to highlights. No threshold, so all light is spread, most of it
-- close by; the picture loses a little of its digital edge everywhere instead of glowing in places.
local fx = require "afterglow"

return fx.stack {
  name = "Filmic scatter",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0, knee = 0, intensity = 0.12, scatter = 0.45, fade_fireflies = true, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.5, contrast = 5, color_filter = { 1.03, 1.0, 0.95 }, saturation = -5 },
  fx.tone_mapping { mode = "aces" },
}
