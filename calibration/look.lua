-- SPDX-License-Identifier: MIT
-- What calibration measures: a pyramid down and up, sharp lights, a tone curve; the kinds of pass that looks are made of.
local fx = require "afterglow"

return fx.stack {
  name = "Calibration",
  fx.bloom { mode = "scattering", threshold = 0.8, intensity = 0.3 },
  fx.tone_mapping { mode = "aces" },
  fx.color_adjustments { post_exposure = 0.2, contrast = 10 },
}
