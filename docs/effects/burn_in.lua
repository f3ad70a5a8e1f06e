-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
  fx.burn_in { text = "ALLEY 010   {frame}   {timecode}", start = "01:00:00:00" },
}
