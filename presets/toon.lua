-- SPDX-License-Identifier: MIT
-- A frame of a Saturday morning: few flat tones, bright colour, ink where things end. Lines come from the picture itself, so photographs work too.
local fx = require "afterglow"

return fx.stack {
  name = "Toon",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 1, intensity = 0.07, scatter = 0.65, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.75, contrast = 4, saturation = 20 },
  fx.tone_mapping { mode = "aces", full_white = true },
  fx.posterize { at = "after_post_process", order = 90, levels = 5, softness = 0.25, shadows = 0.7, opacity = 0.8 },
  fx.edge_detection { at = "after_post_process", order = 100, intensity = 1.2, threshold = 0.35, color = { 0.012, 0.01, 0.02 } },
  fx.smaa {},
}
