-- SPDX-License-Identifier: MIT
-- How one remembers a summer: light leaks into everything, edges give way, colours are of chalk.
local fx = require "afterglow"

return fx.stack {
  name = "Dream haze",
  requires = "0.2",
  reference_height = 1080,
  fx.depth_fog { density = 0.01, start = 3, color = { 0.3, 0.27, 0.34 }, ambient = 0.7, max_opacity = 0.5, sky = 0.3, scattering = 0.8 },
  fx.bloom { mode = "scattering", threshold = 0.3, knee = 1, intensity = 0.34, scatter = 0.72, fade_fireflies = true, edges = "mirror" },
  fx.glare { kind = "fog_glow", threshold = 1, clamp = 12, intensity = 0.15, size = 1.2, tint = { 1, 0.86, 0.95 } },
  fx.chromatic_aberration { intensity = 0.15 },
  fx.vignette { intensity = 0.22, smoothness = 0.8, color = { 0.55, 0.5, 0.62 } },
  fx.curves { blacks = 0.4, shadows = 0.15, highlights = -0.15, whites = -0.4, blue = { 0.2, 0.04, 0 }, red = { 0.12, 0.05, 0 } },
  fx.color_adjustments { post_exposure = 0.5, contrast = 10, saturation = 8 },
  fx.tone_mapping { mode = "neutral" },
}
