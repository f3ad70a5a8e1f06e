-- SPDX-License-Identifier: MIT
-- The look that the first goals are about.
local fx = require "afterglow"
return fx.stack {
  name = "Scatter bloom and ACES",
  fx.bloom { mode = "scattering", intensity = 0.5 },
  fx.tone_mapping { mode = "aces" },
}
