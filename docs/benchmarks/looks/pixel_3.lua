-- SPDX-License-Identifier: MIT
-- One of five_pixel_effects.
local fx = require "afterglow"
return fx.stack { name = "Pixel effect 3", fx.color_adjustments { post_exposure = 0.3 } }
