-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.curves { blacks = -0.8, shadows = -0.3, highlights = 1.2, whites = 0.6, blue = { 0.5, 0, -0.4 }, reds = { -20, 25, 20 }, cyans = { 30, 40, 0 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
