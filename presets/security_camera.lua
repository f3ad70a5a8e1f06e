-- SPDX-License-Identifier: MIT
-- 03:12, camera four: a cheap wide lens, tired tubes, a recorder that has run for years.
local fx = require "afterglow"

return fx.stack {
  name = "Security camera",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.9, knee = 0.6, intensity = 0.22, scatter = 0.55, fade_fireflies = true, edges = "mirror" },
  fx.lens_distortion { intensity = 0.3, scale = 1.08 },
  fx.vignette { intensity = 0.35, smoothness = 0.4 },
  fx.channel_mixer { red_out_red_in = 30, red_out_green_in = 60, red_out_blue_in = 10, green_out_red_in = 30, green_out_green_in = 60, green_out_blue_in = 10,
                     blue_out_red_in = 30, blue_out_green_in = 60, blue_out_blue_in = 10 },
  fx.color_adjustments { post_exposure = 0.7, contrast = 24, color_filter = { 0.86, 1.02, 0.9 } },
  fx.tone_mapping { mode = "reinhard" },
  fx.film_grain { intensity = 0.5, size = 2.2, response = 0.5 },
  fx.glitch { scan_line_jitter = 0.12, line_height = 3, rgb_split = 0 },
  fx.crt { lines = 360, curvature = 0, corner = 0, phosphor = 0, scan_lines = 0.6, glow = 0.1, convergence = 0, vignette = 0, softness = 0.8, brightness = 1.05 },
  fx.letterbox { aspect = 1.3333 },
  fx.burn_in { text = "CAM 04  {timecode}", start = "03:12:00:00", position = { 0.145, 0.03 }, size = 0.035, box = 0, outline = 0.08 },
}
