-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.depth_fog { density = 0.12, start = 4, color = { 0.1, 0.12, 0.2 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
