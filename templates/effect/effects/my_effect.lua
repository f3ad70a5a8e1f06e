local fx = require "afterglow"

return fx.effect {
  name = "my_effect", doc = "Mixes the picture with a colour.",
  at = "after_post_process", order = 0,
  settings = {
    strength = fx.float { min = 0, max = 1, default = 0.5, doc = "Share of the colour. 0: the picture stays as it is." },
    color    = fx.color { default = { 1, 0.5, 0.2 }, doc = "The colour, in the light that the effect is given: linear." },
  },
  active = function(s) return s.strength > 0, "strength is 0" end,
  -- What `afterglow stress --effect my_effect --path .` holds it to.
  holds = { "constant", "mirror", "turn_90", "monotone", shift = 1, continuous = 1 },
  build = function(g, s, source)
    return g:pass { shader = "my_effect/my_effect", source = source, strength = s.strength, tint = s.color }
  end,
}
