-- SPDX-License-Identifier: MIT
-- zoom: 560,0,400,225
local fx = require "afterglow"

return fx.stack {
  fx.chromatic_aberration { intensity = 0.6, samples = 12 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
