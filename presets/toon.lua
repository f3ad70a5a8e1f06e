-- SPDX-License-Identifier: MIT
-- A frame of a Saturday morning: few flat tones, bright colour, ink where things end. Lines come from the picture itself, so photographs work too.
local fx = require "afterglow"

return fx.stack {
  name = "Toon",
  requires = "0.2",
  fx.color_adjustments { post_exposure = 0.75, contrast = 6, saturation = 30 },
  fx.tone_mapping { mode = "agx", look = "punchy" },
  fx.posterize { at = "after_post_process", order = 90, levels = 5, softness = 0.25, opacity = 0.8 },
  fx.edge_detection { at = "after_post_process", order = 100, intensity = 1.2, threshold = 0.35, color = { 0.012, 0.01, 0.02 } },
  fx.smaa {},
}
