-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/alley.exr
local fx = require "afterglow"

return fx.stack {
  fx.auto_exposure { compensation = 0.5, metering = "center" },
  fx.tone_mapping { mode = "neutral" },
}
