-- SPDX-License-Identifier: MIT
-- Rain, neon, and someone to follow: signs burn red halos into the film, wet air carries their colour, and everything else drowns in black.
-- Haze needs depth; pictures without it keep the rest.
local fx = require "afterglow"

return fx.stack {
  name = "Neon noir",
  requires = "0.2",
  reference_height = 1080,
  fx.depth_fog { density = 0.012, start = 4, color = { 0.02, 0.03, 0.06 }, ambient = 0.8, max_opacity = 0.7, sky = 0.2, scattering = 0.6 },
  fx.bloom { mode = "scattering", threshold = 1, knee = 0.7, intensity = 0.16, scatter = 0.72, fade_fireflies = true, edges = "mirror" },
  fx.halation { intensity = 0.1, radius = 10, threshold = 1.5, clamp = 12, color = { 1, 0.16, 0.08 } },
  fx.anamorphic_streaks { threshold = 14, stretch = 0.72, intensity = 0.08, tint = { 0.3, 0.55, 1 } },
  fx.vignette { intensity = 0.32, smoothness = 0.5 },
  fx.split_toning { shadows = "#3f7a86", highlights = "#9c7a74", balance = 15 },
  fx.curves { by = "luminance", blacks = -0.45, shadows = -0.2, midtones = 0.1, highlights = 0.05 },
  fx.color_adjustments { post_exposure = 0.55, contrast = 10, saturation = 6 },
  fx.tone_mapping { mode = "aces" },
  fx.film_grain { intensity = 0.22, size = 1.4 },
  fx.letterbox { aspect = 2.39 },
}
