-- SPDX-License-Identifier: MIT
-- Ten effects, as looks of game studios have them: what all of them cost together.
local fx = require "afterglow"
return fx.stack {
  name = "Cyberpunk night city",
  fx.bloom { mode = "scattering", threshold = 1.0, intensity = 0.25, scatter = 0.75, fade_fireflies = true },
  fx.anamorphic_streaks { threshold = 4, stretch = 0.8, intensity = 0.3, tint = "#4080ff" },
  fx.lens_dirt { intensity = 0.6 },
  fx.chromatic_aberration { intensity = 0.2 },
  fx.vignette {},
  fx.split_toning { shadows = "#304a80", highlights = "#c06090" },
  fx.tone_mapping { mode = "aces" },
  fx.color_adjustments { post_exposure = 1, contrast = 15, saturation = 15 },
  fx.lut { file = "luts/teal_orange.cube", intensity = 0.6 },
  fx.film_grain {},
}
