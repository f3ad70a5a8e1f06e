-- SPDX-License-Identifier: MIT
-- A shot through an image intensifier: green light alone, amplified, glaring at every lamp. Shows that a stack runs by injection point:
-- the blit comes first (after_opaque_and_sky) wherever it stands in the list.
local fx = require "afterglow"

return fx.stack {
  name = "Night vision",
  fx.bloom { mode = "additive", threshold = 0.6, knee = 0.8, intensity = 0.02, max_iterations = 6, fade_fireflies = true },
  fx.color_blit { intensity = 2 },
  fx.color_adjustments { post_exposure = 0.3, contrast = 30, saturation = -8 },
  fx.tone_mapping { mode = "reinhard" },
}
