-- Tone mapping: one curve per look, chosen by name. Light above 60 counts as 60, as in the sources of all three curves.
local fx = require "afterglow"

return fx.effect {
  name = "tone_mapping",
  doc = "Brings scene-linear light into display range.",
  at = "post_process", order = 200,
  settings = {
    mode = fx.enum { "none", "aces", "neutral", "reinhard", default = "aces",
      doc = "Curve. aces: filmic contrast, bright colours turn white. neutral: Hable's curve, white at 4, hues kept. reinhard: x/(1+x), soft and flat." },
  },
  active = function(s) return s.mode ~= "none", "mode is none" end,
  holds = {
    "black", "constant", "mirror", "turn_180", "turn_90", "monotone",
    shift = 1, bounded = { from = 0, to = 1.21, when = function(s) return s.mode ~= "none" end }, continuous = 1.1, error = 1e-5,
  },
  build = function(g, s, source) return g:pass { shader = "tone_mapping/" .. s.mode, source = source, name = s.mode } end,
}
