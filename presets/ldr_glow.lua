-- SPDX-License-Identifier: MIT
-- Screenshots, photographs and other 8-bit pictures: they hold nothing above 1, so the threshold is low, and light is spread rather than
-- added, so that nothing clips which did not before. No tone curve, as the picture already has one.
local fx = require "afterglow"

return fx.stack {
  name = "Punchy LDR glow",
  requires = "0.2",
  reference_height = 1080,
  fx.bloom { mode = "scattering", threshold = 0.65, knee = 0.5, intensity = 0.35, scatter = 0.6, edges = "mirror" },
  fx.color_adjustments { post_exposure = -0.15, contrast = 8, saturation = 15 },
}
