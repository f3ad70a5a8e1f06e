-- SPDX-License-Identifier: MIT
-- One of five_pixel_effects.
local fx = require "afterglow"
return fx.stack { name = "Pixel effect 5", fx.color_adjustments { saturation = 10 } }
