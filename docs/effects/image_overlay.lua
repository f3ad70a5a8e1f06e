-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
  fx.image_overlay { file = "overlays/light_leak.png", blend = "screen", fit = "cover" },
}
