-- SPDX-License-Identifier: MIT
-- input: tests/images/showcase/sea.exr --set cdl.slope=1.4,1.2,1
local fx = require "afterglow"

return fx.stack {
  fx.cdl { slope = { 3.4, 2.9, 2.4 }, offset = { 0.01, 0.01, 0.03 }, power = { 0.95, 1, 1.05 }, saturation = 1.2 },
  fx.tone_mapping { mode = "neutral" },
}
