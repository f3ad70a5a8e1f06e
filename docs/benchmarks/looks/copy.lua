-- SPDX-License-Identifier: MIT
-- A pass that changes nothing, executed like any other.
local fx = require "afterglow"
return fx.stack { name = "Copy", fx.copy {} }
