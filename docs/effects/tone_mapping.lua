local fx = require "afterglow"

return fx.stack {
  fx.tone_mapping { mode = "aces" },
  fx.color_adjustments { post_exposure = 1.5 },
}
