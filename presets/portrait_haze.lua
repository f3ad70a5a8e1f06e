-- SPDX-License-Identifier: MIT
-- Faces and beauty shots: a diffusion filter in front of the lens. Wide scattering of everything above the mid tones lifts shadows next to
-- light skin, and soft contrast with a warm filter does the rest.
local fx = require "afterglow"

return fx.stack {
  name = "Soft portrait haze",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.5, knee = 1.0, intensity = 0.22, scatter = 0.7, fade_fireflies = true, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.7, contrast = 10, color_filter = "#fff4ea", saturation = 2 },
  fx.tone_mapping { mode = "neutral" },
}
