-- SPDX-License-Identifier: MIT
-- One of five_pixel_effects.
local fx = require "afterglow"
return fx.stack { name = "Pixel effect 1", fx.color_blit { intensity = 1.5 } }
