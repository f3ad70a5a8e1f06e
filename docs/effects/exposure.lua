-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/alley.exr --set exposure.ev=1.5
local fx = require "afterglow"

return fx.stack {
  fx.exposure { ev = 2.5 },
  fx.tone_mapping { mode = "neutral" },
}
