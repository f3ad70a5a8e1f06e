-- SPDX-License-Identifier: MIT
local fx = require "afterglow"
return fx.effect {
  name = "copy", doc = "Nothing, pixel by pixel: what a pass costs before it does anything.",
  at = "post_process", order = 1, settings = {},
  build = function(g, s, source) return g:pass { shader = "copy/copy", source = source } end,
}
