-- SPDX-License-Identifier: MIT
-- For the shop window: true colours, quiet highlights, soft contact shadows, nothing that draws attention to itself.
local fx = require "afterglow"

return fx.stack {
  name = "Clean product shot",
  requires = "0.2",
  reference_height = 1080,
  fx.ssao { radius = 0.4, intensity = 0.7, samples = 24 },
  fx.bloom { mode = "scattering", threshold = 1.2, knee = 0.6, intensity = 0.06, scatter = 0.6, fade_fireflies = true, edges = "mirror" },
  fx.curves { by = "luminance", shadows = 0.12, highlights = -0.08 },
  fx.color_adjustments { post_exposure = 0.35, contrast = 8 },
  fx.tone_mapping { mode = "khronos_neutral" },
  fx.smaa {},
  fx.sharpen { intensity = 0.3 },
}
