-- SPDX-License-Identifier: MIT
-- Shot at noon, set at midnight: the old trick of Westerns. Two stops under, blue through the filter, the sun plays the moon.
local fx = require "afterglow"

return fx.stack {
  name = "Day for night",
  requires = "0.2",
  reference_height = 1080,
  fx.glare { kind = "fog_glow", threshold = 1, clamp = 60, intensity = 0.3, size = 0.5, tint = { 0.6, 0.78, 1 } },
  fx.vignette { intensity = 0.36, smoothness = 0.6 },
  fx.channel_mixer { red_out_red_in = 45, red_out_green_in = 30, red_out_blue_in = 5, green_out_red_in = 12, green_out_green_in = 78, green_out_blue_in = 10,
                     blue_out_red_in = 14, blue_out_green_in = 36, blue_out_blue_in = 75 },
  fx.curves { by = "luminance", whites = -2.8, highlights = -1.6, midtones = -0.3, shadows = 0, blacks = -0.3 },
  fx.color_adjustments { post_exposure = 0.35, contrast = 10, color_filter = { 0.62, 0.82, 1.25 }, saturation = -12 },
  fx.tone_mapping { mode = "aces" },
  fx.film_grain { intensity = 0.2, size = 1.4 },
}
