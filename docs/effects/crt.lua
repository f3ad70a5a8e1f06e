-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.crt { lines = 180 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
