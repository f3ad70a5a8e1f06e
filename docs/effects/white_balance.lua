local fx = require "afterglow"

return fx.stack {
  fx.white_balance { temperature = 60, tint = 10 },
  fx.tone_mapping { mode = "neutral" },
  fx.color_adjustments { post_exposure = 1.5 },
}
