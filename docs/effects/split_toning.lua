-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set color_adjustments.post_exposure=0.3
local fx = require "afterglow"

return fx.stack {
  fx.split_toning { shadows = "#2a5a80", highlights = "#c89050" },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
