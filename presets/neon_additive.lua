-- SPDX-License-Identifier: MIT
-- Title cards and arcade looks: glow that is added on top, loud and saturated. Every level of the pyramid adds its own halo, so few
-- iterations keep it tight around the tubes. AgX lets the hearts of tubes
-- go white by way of paler colour, so that bright skies stay without contours.
local fx = require "afterglow"

return fx.stack {
  name = "Additive neon",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "additive", threshold = 1.2, knee = 0.3, intensity = 0.15, clamp = 60, max_iterations = 5, fade_fireflies = true, edges = "mirror" },
  fx.color_adjustments { post_exposure = -0.15, contrast = 4, saturation = 20 },
  fx.tone_mapping { mode = "agx", look = "punchy" },
}
