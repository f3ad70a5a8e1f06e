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
  build = function(g, s, source)
    local x, y = (s.to[1] - s.from[1]) * source.width, (s.to[2] - s.from[2]) * source.height
    local function share(way) return math.max(-1e20, math.min(way / (x * x + y * y), 1e20)) end
    return g:pass { shader = "mask/linear", source = source, from = s.from, along = { share(x), share(y) } }
  end,
}
