-- SPDX-License-Identifier: MIT
-- The last half hour of sun: light turns to honey, shadows stay cool, and the air between glows.
local fx = require "afterglow"

return fx.stack {
  name = "Golden hour",
  requires = "0.2",
  reference_height = 1080,
  fx.depth_fog { density = 0.004, start = 6, color = { 0.32, 0.24, 0.17 }, ambient = 0.6, max_opacity = 0.45, sky = 0.3, scattering = 0.6 },
  fx.glare { kind = "fog_glow", threshold = 1, clamp = 30, intensity = 0.22, size = 0.9, tint = { 1, 0.82, 0.58 } },
  fx.vignette { intensity = 0.2, smoothness = 0.6, color = { 0.12, 0.06, 0.03 } },
  fx.white_balance { temperature = 28, tint = 5 },
  fx.curves { shadows = 0.35, highlights = -0.1, blue = { 0.22, -0.05, -0.2 }, red = { -0.05, 0.05, 0.05 }, yellows = { -8, 10, 0 } },
  fx.color_adjustments { post_exposure = 0.4, contrast = 2, color_filter = { 1.05, 0.99, 0.9 }, saturation = 4 },
  fx.tone_mapping { mode = "aces", full_white = true },  -- turns bright reds to amber, as flames are; AgX would leave lanterns pink
  fx.film_grain { intensity = 0.1, size = 1.3 },
}
