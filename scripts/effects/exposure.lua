-- SPDX-License-Identifier: MIT
-- Exposure: light times 2^ev, as by a camera's shutter. It comes first of all that is done at `post_process`, so that whatever asks how bright light
-- is (the threshold of a bloom, the tone curve) finds the light as it was exposed. `auto_exposure` meters what it gets and would take
-- this back: beside it, use its `compensation`.
local fx = require "afterglow"

return fx.effect {
  name = "exposure",
  doc = "Exposure of the scene, in stops; before the bloom and the tone curve.",
  at = "post_process", order = 0, space = "scene",
  settings = { ev = fx.float { min = -64, max = 64, default = 0, unit = "EV", doc = "Light times 2^ev: 1 is twice as bright, -1 half." } },
  active = function(s) return s.ev ~= 0, "ev is 0" end,
  holds = {
    "black", "constant", "monotone", "mirror", "turn_180", "turn_90", shift = 1,
    linear = { when = function(s) return s.ev <= 10 end },
    continuous = { slope = function(s) return 2.0 ^ s.ev end, when = function(s) return s.ev <= 10 end },
    error = { fp32 = 1e-6, when = function(s) return s.ev <= 10 end },
  },
  build = function(g, s, source) return g:pass { shader = "exposure/expose", source = source, factor = 2.0 ^ s.ev } end,
}
