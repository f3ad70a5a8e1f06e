-- SPDX-License-Identifier: MIT
-- Title cards and arcade looks: glow that is added on top, loud and saturated. Every level of the pyramid adds its own halo, so few
-- iterations keep it tight around the tubes. The neutral curve keeps the hues that ACES would bleach.
local fx = require "afterglow"

return fx.stack {
  name = "Additive neon",
  fx.bloom { mode = "additive", threshold = 1.2, knee = 0.3, intensity = 0.08, max_iterations = 5, fade_fireflies = true },
  fx.color_adjustments { contrast = 10, saturation = 25 },
  fx.tone_mapping { mode = "neutral" },
}
