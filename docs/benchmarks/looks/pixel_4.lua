-- SPDX-License-Identifier: MIT
-- One of five_pixel_effects.
local fx = require "afterglow"
return fx.stack { name = "Pixel effect 4", fx.tone_mapping { mode = "reinhard" } }
