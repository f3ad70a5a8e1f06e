local fx = require "afterglow"

return fx.stack {
  fx.tone_mapping { mode = "neutral" },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.lut { file = "luts/teal_orange.cube" },
}
