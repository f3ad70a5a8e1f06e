local fx = require "afterglow"

return fx.stack {
  fx.bokeh_blur { radius = 7, blades = 6 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
