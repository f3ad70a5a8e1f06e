-- SPDX-License-Identifier: MIT
-- Effects with their default settings, all off: a goal turns on the one that it measures.
local fx = require "afterglow"
return fx.stack { name = "Each effect",
  fx.depth_of_field { enabled = false },
  fx.bokeh_blur { enabled = false },
  fx.radial_blur { enabled = false },
  fx.lens_dirt { enabled = false },
  fx.chromatic_aberration { enabled = false },
  fx.directional_blur { enabled = false },
  fx.firefly_stabilisation { enabled = false },
  fx.edge_detection { enabled = false },
  fx.dual_kawase { enabled = false },
  fx.fxaa { enabled = false },
  fx.outline { enabled = false },
  fx.tone_mapping { mode = "aces", enabled = false },
  fx.lut { file = "luts/teal_orange.cube", enabled = false },
  fx.color_adjustments { post_exposure = 1.5, contrast = 30, saturation = 40, hue_shift = 30, enabled = false },
  fx.film_grain { enabled = false },
  fx.lift_gamma_gain { gamma = { 1, 0.9, 0.8 }, gain_offset = 0.1, enabled = false },
}
