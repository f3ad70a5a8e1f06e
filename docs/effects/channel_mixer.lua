-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.channel_mixer { red_out_red_in = 20, red_out_green_in = 80, blue_out_blue_in = 60, blue_out_red_in = 60 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
