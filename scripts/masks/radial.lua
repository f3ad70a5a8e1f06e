-- SPDX-License-Identifier: MIT
-- An ellipse.
local fx = require "afterglow"

return fx.effect {
  name = "radial",
  doc = "An ellipse with a soft edge.",
  settings = {
    center = fx.vec2 { min = -10, max = 10, default = { 0.5, 0.5 }, doc = "In pictures: {0, 0} is the upper left corner, {1, 1} the lower right." },
    radius = fx.vec2 { min = 0, max = 100, default = { 0.35, 0.35 }, doc = "Across and down, in heights of the picture." },
    softness = fx.float { min = 0, max = 100, default = 0.25, doc = "How far the edge goes outside, in heights of the picture." },
    rotation = fx.float { min = -360, max = 360, default = 0, unit = "degrees", doc = "Turns the ellipse clockwise." },
  },
  active = function(s) return s.radius[1] > 0 and s.radius[2] > 0, "radius is 0" end,
  build = function(g, s, source)
    local angle = math.rad(s.rotation)
    return g:pass { shader = "mask/radial", source = source, center = s.center,
                    radius = { math.max(s.radius[1], 1e-6), math.max(s.radius[2], 1e-6) },
                    soft = math.max(s.softness, 1e-6), turn = { math.cos(angle), math.sin(angle) } }
  end,
}
