-- SPDX-License-Identifier: MIT
-- Family albums and flashbacks: a print that has lain in the sun. Blacks are lifted and blue, whites are yellow, colour has gone thin; the
-- grain is coarse.
local fx = require "afterglow"

return fx.stack {
  name = "Faded film",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.4, knee = 1, intensity = 0.15, scatter = 0.6, fade_fireflies = true, edges = "mirror" },
  fx.vignette { intensity = 0.3, smoothness = 0.6, color = { 0.25, 0.16, 0.1 } },
  fx.white_balance { temperature = 18, tint = -6 },
  fx.channel_mixer { red_out_red_in = 90, red_out_green_in = 10, green_out_green_in = 92, green_out_red_in = 8,
                     blue_out_blue_in = 80, blue_out_green_in = 20 },
  fx.lift_gamma_gain { lift = { 0.96, 1, 1.05 }, lift_offset = 0.004, gamma_offset = 0.04, gain = { 1.08, 1, 0.88 } },
  fx.color_adjustments { post_exposure = 0.65, contrast = 6, saturation = -14 },
  fx.tone_mapping { mode = "neutral" },
  fx.film_grain { intensity = 0.22, response = 0.7, size = 2 },
}
