-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.shadows_midtones_highlights { shadows = { 0.5, 0.8, 1.6 }, shadows_offset = 0.15, highlights = { 1.2, 1, 0.8 } },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
