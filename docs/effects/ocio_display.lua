-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.color_adjustments { post_exposure = 1.5 },
  fx.ocio_display { config = "ocio/aces.ocio" },
}
