-- SPDX-License-Identifier: MIT
-- Night exteriors and neon, shot on an old anamorphic lens: flat blue flares, fringes towards the corners, light that falls off, teal
-- shadows against warm highlights, and fine grain that is new in every frame.
local fx = require "afterglow"

return fx.stack {
  name = "Anamorphic night",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 1, knee = 0.6, intensity = 0.18, scatter = 0.65, fade_fireflies = true, edges = "mirror" },
  fx.anamorphic_streaks { threshold = 8, stretch = 0.7, intensity = 0.2, tint = { 0.35, 0.5, 1 } },
  fx.chromatic_aberration { intensity = 0.2, samples = 8 },
  fx.vignette { intensity = 0.25, smoothness = 0.5 },
  fx.split_toning { shadows = "#5a7f8c", highlights = "#94826c", balance = 10 },
  fx.color_adjustments { post_exposure = 0.75, contrast = 10, saturation = -4 },
  fx.tone_mapping { mode = "aces" },
  fx.film_grain { intensity = 0.3, size = 1.3, colored = 0.3 },
}
