-- SPDX-License-Identifier: MIT
-- The night the series ends on: skies too blue, windows too warm, and every lamp a small star.
local fx = require "afterglow"

return fx.stack {
  name = "Anime night",
  requires = "0.2",
  reference_height = 1080,
  fx.depth_fog { density = 0.008, start = 5, color = { 0.08, 0.1, 0.26 }, ambient = 0.55, max_opacity = 0.6, sky = 0.25, scattering = 0.7 },
  fx.bloom { mode = "scattering", threshold = 0.8, knee = 0.8, intensity = 0.2, scatter = 0.75, fade_fireflies = true, edges = "mirror" },
  fx.glare { kind = "star", threshold = 30, clamp = 80, points = 4, angle = 45, size = 0.08, intensity = 0.09, dispersion = 0.6, tint = { 1, 0.95, 1 } },
  fx.lens_flare { threshold = 20, clamp = 80, ghosts = 0.06, halo = 0.02, starburst = 0, count = 5 },
  fx.curves { shadows = 0.3, midtones = 0.1, blue = { 0.4, 0.12, 0 }, red = { -0.1, 0, 0.05 }, green = { -0.04, 0, 0 }, blues = { 0, 25, 12 }, magentas = { 6, 18, 0 },
              yellows = { -10, 18, 6 }, cyans = { 10, 20, 8 } },
  fx.color_adjustments { post_exposure = 0.3, contrast = 2, saturation = 18 },
  fx.tone_mapping { mode = "agx", look = "punchy" },
}
