-- SPDX-License-Identifier: MIT
-- A shot through an image intensifier: green light alone, amplified and noisy, glaring at every lamp, in a round eyepiece. Shows that a stack runs by injection point:
-- the blit comes first (after_opaque_and_sky) wherever it stands in the list.
local fx = require "afterglow"

return fx.stack {
  name = "Night vision",
  requires = "0.2",
  reference_height = 1080,
  fx.color_blit { intensity = 2 },
  fx.bloom { mode = "additive", threshold = 0.6, knee = 0.8, intensity = 0.05, max_iterations = 6, fade_fireflies = true, edges = "mirror" },
  fx.lens_distortion { intensity = 0.12, scale = 1.03 },
  fx.vignette { intensity = 0.46, smoothness = 0.1, rounded = true },
  fx.color_adjustments { post_exposure = 0.8, contrast = 30, saturation = -8 },
  fx.tone_mapping { mode = "reinhard" },
  fx.film_grain { intensity = 0.55, size = 1.6, response = 0.6 },
}
