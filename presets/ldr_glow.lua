-- Screenshots, photographs and other 8-bit pictures: they hold nothing above 1, so a low, hard, linear threshold and plain blurs do what
-- an HDR bloom cannot. No tone curve, as the picture already has one.
local fx = require "afterglow"

return fx.stack {
  name = "Punchy LDR glow",
  fx.box_bloom { threshold = 0.7, blur_iterations = 6, pattern = "box", brightness = "luma" },
  fx.color_adjustments { post_exposure = -0.1, contrast = 12, saturation = 15 },
}
