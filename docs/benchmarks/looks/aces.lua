-- SPDX-License-Identifier: MIT
-- The tone curve alone.
local fx = require "afterglow"
return fx.stack { name = "ACES", fx.tone_mapping { mode = "aces" } }
