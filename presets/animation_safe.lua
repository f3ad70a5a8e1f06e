-- SPDX-License-Identifier: MIT
-- Path-traced sequences: noise leaves single pixels of thousands, new ones every frame, and an ordinary bloom turns each into a flickering
-- disc. Here fireflies are faded before the pyramid, the knee is wide so that nothing pops in, and the finest levels count least.
local fx = require "afterglow"

return fx.stack {
  name = "Animation-safe glow",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 1.1, knee = 1.0, intensity = 0.15, scatter = 0.8, fade_fireflies = true,
             downscale_limit = 8, edges = "mirror" },
  fx.color_adjustments { post_exposure = 0.4 },
  fx.tone_mapping { mode = "aces" },
}
