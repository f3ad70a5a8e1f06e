-- SPDX-License-Identifier: MIT
-- input: tests/images/blender/fireflies.####.exr --frames 6 --set color_adjustments.post_exposure=-1
-- zoom: 96,54,96,54
local fx = require "afterglow"

return fx.stack {
  fx.firefly_stabilisation { first_frame = "clamp", threshold = 0.25 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
