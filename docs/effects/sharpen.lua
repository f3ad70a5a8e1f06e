local fx = require "afterglow"

return fx.stack {
  fx.sharpen { intensity = 1, contrast = 1 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
