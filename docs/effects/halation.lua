-- SPDX-License-Identifier: MIT
-- zoom: 240,40,480,270
local fx = require "afterglow"

return fx.stack {
  fx.halation { intensity = 0.3, radius = 10 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
