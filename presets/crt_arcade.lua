-- SPDX-License-Identifier: MIT
-- Insert coin: a cabinet in a dark hall, colours that shout, glass that bends the light of 240 lines.
local fx = require "afterglow"

return fx.stack {
  name = "CRT arcade",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.9, knee = 0.6, intensity = 0.12, scatter = 0.6, fade_fireflies = true, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.7, contrast = 4, saturation = 26 },
  fx.tone_mapping { mode = "aces", full_white = true },
  fx.crt { lines = 240, curvature = 0.4, phosphor = 0.45, scan_lines = 0.95, glow = 0.2, vignette = 0.4, corner = 0.06, brightness = 1.05 },
}
