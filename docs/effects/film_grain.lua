local fx = require "afterglow"

return fx.stack {
  fx.film_grain { intensity = 0.8, size = 1.5 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
