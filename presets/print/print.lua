-- SPDX-License-Identifier: MIT
-- Posters and comics: tone-mapped, then screened into dots of ink on paper. The halftone is an effect of this preset's own: it lives
-- beside it (effects/halftone.lua, shaders/halftone/dots.glsl) and the program knows nothing about it. A start for effects of your own.
local fx = require "afterglow"

return fx.stack {
  name = "Print",
  requires = "0.2",
  fx.bloom { mode = "scattering", intensity = 0.15, fade_fireflies = true },
  fx.color_adjustments { post_exposure = 2, contrast = 18, saturation = 8 },
  fx.tone_mapping { mode = "neutral" },
  fx.halftone { cell = 6, angle = 30, ink = "#14101c", paper = "#f4ecd8", tint = 0.75 },
}
