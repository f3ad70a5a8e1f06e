-- SPDX-License-Identifier: MIT
-- What the examples of the effects start from.
local fx = require "afterglow"

return fx.stack {
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
