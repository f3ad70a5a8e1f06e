-- SPDX-License-Identifier: MIT
local fx = require "afterglow"

return fx.stack {
  fx.lens_dirt { threshold = 1, intensity = 0.6, density = 0.6, size = 0.1 },
  fx.color_adjustments { post_exposure = 1.5 },
  fx.tone_mapping { mode = "neutral" },
}
