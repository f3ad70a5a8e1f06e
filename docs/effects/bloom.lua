local fx = require "afterglow"

return fx.stack {
  fx.bloom { mode = "scattering", intensity = 0.2, fade_fireflies = true },
  fx.tone_mapping { mode = "neutral" },
  fx.color_adjustments { post_exposure = 1.5 },
}
