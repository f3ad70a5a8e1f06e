-- SPDX-License-Identifier: MIT
-- One of five_pixel_effects.
local fx = require "afterglow"
return fx.stack { name = "Pixel effect 2", fx.tone_mapping { mode = "neutral" } }
