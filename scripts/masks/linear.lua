-- SPDX-License-Identifier: MIT
-- A gradient.
local fx = require "afterglow"

return fx.effect {
  name = "linear",
  doc = "A gradient: nothing on one side of the picture, everything on the other.",
  settings = {
    from = fx.vec2 { min = -10, max = 10, default = { 0.5, 0 }, doc = "Where nothing counts, in pictures: {0, 0} is the upper left corner." },
    to = fx.vec2 { min = -10, max = 10, default = { 0.5, 1 }, doc = "Where everything does." },
  },
  active = function(s) return s.from[1] ~= s.to[1] or s.from[2] ~= s.to[2], "from and to are the same point" end,
  build = function(g, s, source) return g:pass { shader = "mask/linear", source = source, from = s.from, to = s.to } end,
}
