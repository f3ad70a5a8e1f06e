-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.white_balance { temperature = 60, tint = 10 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
