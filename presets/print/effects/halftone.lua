-- SPDX-License-Identifier: MIT
-- Halftone: dots of ink whose area stands for darkness. An effect that belongs to one preset; copy the folder to make your own.
local fx = require "afterglow"

return fx.effect {
  name = "halftone",
  doc = "Screens the picture into a rotated grid of ink dots on paper; best after tone mapping.",
  at = "after_post_process", order = 150,
  settings = {
    cell = fx.float { min = 2, max = 256, default = 6, unit = "px", doc = "Distance between dots." },
    angle = fx.float { min = -90, max = 90, default = 30, unit = "degrees", doc = "Rotation of the grid." },
    ink = fx.color { default = { 0, 0, 0 }, doc = "Colour of the dots." },
    paper = fx.color { default = { 1, 1, 1 }, doc = "Colour between the dots." },
    tint = fx.float { min = 0, max = 1, default = 0, doc = "How much of the picture's own colour the paper takes on, as with a flat colour print below the ink." },
  },
  build = function(g, s, source)
    local radians = s.angle * math.pi / 180
    return g:pass {
      shader = "halftone/dots", source = source,
      cell = s.cell, rotation = { math.cos(radians), math.sin(radians) },
      ink = s.ink, paper = s.paper, tint = s.tint,
    }
  end,
}
