-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.exposure { ev = 2.5 },
  fx.tone_mapping { mode = "neutral" },
}
