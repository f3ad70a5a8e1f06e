local fx = require "afterglow"

return fx.stack {
  fx.fxaa {},
  fx.tone_mapping { mode = "neutral" },
  fx.color_adjustments { post_exposure = 1.5 },
}
