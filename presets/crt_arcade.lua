-- SPDX-License-Identifier: MIT
-- Insert coin: a cabinet in a dark hall, colours that shout, glass that bends the light of 240 lines.
local fx = require "afterglow"

return fx.stack {
  name = "CRT arcade",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.9, knee = 0.6, intensity = 0.12, scatter = 0.6, fade_fireflies = true },
  fx.color_adjustments { post_exposure = 0.85, contrast = 6, saturation = 35 },
  fx.tone_mapping { mode = "agx", look = "punchy" },
  fx.crt { lines = 240, curvature = 0.4, phosphor = 0.45, scan_lines = 0.95, glow = 0.2, vignette = 0.4, corner = 0.06, brightness = 1.05 },
}
