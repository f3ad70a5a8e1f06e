-- SPDX-License-Identifier: MIT
-- Dailies and reviews: nothing but the display transform, to see the render as it is. Try `--set tone_mapping.mode=neutral`.
local fx = require "afterglow"

return fx.stack {
  name = "Plain ACES",
  requires = "0.2",
  fx.tone_mapping { mode = "aces" },
}
