-- SPDX-License-Identifier: MIT
-- Product and portrait shots of a scene with depth: a fast lens a few metres away, everything behind falls apart into discs, dust on the glass
-- catches the lights. Set the distance with `--set depth_of_field.focus_distance=3`, or let `depth_of_field.focus_mode=point` find it; without depth the blur is
-- skipped with a warning.
local fx = require "afterglow"

return fx.stack {
  name = "Shallow focus",
  requires = "0.2",
  reference_height = 1080,
  fx.depth_of_field { focus_distance = 7, aperture = 1.4, focal_length = 85, max_radius = 24 },
  fx.bloom { mode = "scattering", threshold = 0.8, knee = 0.8, intensity = 0.14, scatter = 0.6, fade_fireflies = true, edges = "mirror" },
  fx.lens_dirt { threshold = 2, intensity = 0.1, density = 0.35, size = 0.09 },
  fx.vignette { intensity = 0.25, smoothness = 0.5 },
  fx.shadows_midtones_highlights { shadows = { 0.9, 0.98, 1.1 }, highlights = { 1.04, 1, 0.94 } },
  fx.color_adjustments { post_exposure = 1.0, contrast = 4, saturation = 5 },
  fx.tone_mapping { mode = "aces" },
  fx.sharpen { intensity = 0.4 },
}
