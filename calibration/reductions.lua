-- SPDX-License-Identifier: MIT
-- What calibration decides about compute shaders by: passes that bring a whole picture down to one pixel, in both ways.
local fx = require "afterglow"

return fx.stack {
  name = "Calibration of reductions",
  fx.auto_exposure {},
  fx.tone_mapping { mode = "aces" },
}
