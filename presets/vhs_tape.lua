-- SPDX-License-Identifier: MIT
-- A tape that was played too often: soft, smeared sideways, colours that no longer lie on each other, lines that jump, the bulge of the
-- tube. Every frame is another and the same one each time it is made, so sequences can be rendered in any order.
local fx = require "afterglow"

return fx.stack {
  name = "VHS tape",
  requires = "0.2",
  reference_height = 1080,
  fx.directional_blur { distance = 3 },
  fx.bloom { mode = "scattering", threshold = 0.6, knee = 1, intensity = 0.2, scatter = 0.5, fade_fireflies = true, edges = "mirror" },
  fx.lens_distortion { intensity = 0.12, scale = 1.04 },
  fx.vignette { intensity = 0.3, smoothness = 0.3, rounded = false },
  fx.white_balance { temperature = -12, tint = 14 },
  fx.color_adjustments { post_exposure = 1.0, contrast = 18 },
  -- Not on bright light: a channel below 0 stays 0 under the tone curve, and neon would turn to pure magenta and cyan.
  fx.color_adjustments { order = 191, saturation = 10, mask = fx.mask.luma { from = 1.5, softness = 1.5, invert = true } },
  fx.tone_mapping { mode = "reinhard" },
  fx.film_grain { intensity = 0.4, response = 0.4, size = 1.6, colored = 1 },
  fx.glitch { scan_line_jitter = 0.05, line_height = 2, rgb_split = 0.02, horizontal_shake = 0.02, edges = "stretch" },
}
