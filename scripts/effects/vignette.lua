-- SPDX-License-Identifier: MIT
-- Vignette: light falls off towards the corners. Formula and scales of Unity's URP (UberPost: ApplyVignette).
local fx = require "afterglow"

return fx.effect {
  name = "vignette",
  doc = "Darkens or colours the picture towards its corners.",
  at = "post_process", order = 145,
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.4, doc = "How far the darkness comes in. 0: none." },
    smoothness = fx.float { min = 0.01, max = 1, default = 0.4, doc = "How gently the darkness begins." },
    color = fx.color { default = { 0, 0, 0 }, doc = "What the picture is multiplied by where the vignette is full." },
    center = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "The brightest point: {0, 0} is the upper left corner, {1, 1} the lower right." },
    rounded = fx.bool { default = false, doc = "A circle, whatever the shape of the picture; else it is as wide and high as the picture." },
  },
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    return s.color[1] ~= 1 or s.color[2] ~= 1 or s.color[3] ~= 1, "color is white"
  end,
  -- Where hardly anything is kept, 1 - d² is a small difference, and a power of it.
  holds = {
    "black", "monotone",
    linear = 1e-5, continuous = function(s) return math.max(1, s.color[1], s.color[2], s.color[3]) end,
    mirror = { within = 1e-6, when = function(s) return s.center[1] == 0.5 and s.center[2] == 0.5 end },
    turn_180 = { within = 1e-6, when = function(s) return s.center[1] == 0.5 and s.center[2] == 0.5 end },
    error = { fp32 = 1e-3, when = function(s) return math.max(s.color[1], s.color[2], s.color[3]) <= 1e5 end },
  },
  build = function(g, s, source)
    local aspect = s.rounded and source.width / source.height or 1
    return g:pass { shader = "vignette/darken", source = source, center = s.center, extent = { 3 * s.intensity * aspect, 3 * s.intensity },
                    power = 5 * s.smoothness, corner = s.color }
  end,
}
