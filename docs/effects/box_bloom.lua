local fx = require "afterglow"

return fx.stack {
  fx.box_bloom { threshold = 3, blur_iterations = 3, pattern = "box" },
  fx.tone_mapping { mode = "neutral" },
  fx.color_adjustments { post_exposure = 1.5 },
}
