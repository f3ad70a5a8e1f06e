local fx = require "afterglow"

return fx.stack {
  fx.glare { kind = "star", threshold = 20, points = 6 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
