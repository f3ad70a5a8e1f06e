-- SPDX-License-Identifier: MIT
-- What `afterglow bench --temporal` measures for stability.md: a bloom alone, so that what the look adds is its light.
local fx = require "afterglow"

return fx.stack { name = "Steady", fx.bloom { intensity = 0.5 } }
