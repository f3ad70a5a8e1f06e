-- SPDX-License-Identifier: MIT
-- Colour negative, printed with care: soft shoulders, red halos at the lamps, cool shadows, grain you can almost touch.
local fx = require "afterglow"

return fx.stack {
  name = "Analog film",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.2, knee = 1, intensity = 0.1, scatter = 0.5, fade_fireflies = true, edges = "mirror" },
  fx.halation { intensity = 0.12, radius = 11, threshold = 1.2, clamp = 14 },
  fx.vignette { intensity = 0.2, smoothness = 0.5 },
  fx.curves { blacks = 0.6, shadows = 0.2, highlights = -0.1, red = { -0.12, 0.02, 0.06 }, green = { 0.02, 0, 0.02 }, blue = { 0.2, 0, -0.16 },
              greens = { 12, -18, -4 }, blues = { -10, -12, 0 } },
  fx.color_adjustments { post_exposure = 0.35, contrast = 4, saturation = 6 },
  fx.tone_mapping { mode = "aces", full_white = true },
  fx.film_grain { intensity = 0.34, size = 1.6, response = 0.6, colored = 0.35 },
}
