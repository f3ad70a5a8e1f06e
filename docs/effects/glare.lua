-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.glare { kind = "star", threshold = 14, size = 0.3 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
