-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.transition { kind = "iris", progress = 0.6, softness = 0.02, color = "#1b2a4a" },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
