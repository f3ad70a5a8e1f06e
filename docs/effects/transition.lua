-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.transition { kind = "wipe", to = "sea.jpg", progress = 0.55, angle = 20, softness = 0.1 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
