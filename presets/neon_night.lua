-- SPDX-License-Identifier: MIT
-- Night scenes with tubes and signs: for the look author who wants glow that spreads as in a lens, a little more punch, and a
-- filmic curve. Scattering keeps the light of the picture: walls near a tube take colour from it, and nothing clips early.
local fx = require "afterglow"

return fx.stack {
  name = "Neon night",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 1.0, knee = 0.5, intensity = 0.2, scatter = 0.7,
             max_iterations = 16, downscale_limit = 2, bicubic_upsampling = true, fade_fireflies = true, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.3, contrast = 15, saturation = 10 },
  fx.tone_mapping { mode = "aces" },
}
