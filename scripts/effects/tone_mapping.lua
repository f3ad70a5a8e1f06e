-- Tone mapping: one curve per look, chosen by name. Light above 60 counts as 60, as in the sources of all three curves.
local fx = require "afterglow"

-- The published ACES transform dips below black where greys are below 1e-4, and sums channels of both signs.
local function by_curve(aces, other) return function(s) return s.mode == "aces" and aces or other end end

return fx.effect {
  name = "tone_mapping",
  doc = "Brings scene-linear light into display range.",
  at = "post_process", order = 200, alpha = "straight",
  settings = {
    mode = fx.enum { "none", "aces", "neutral", "reinhard", default = "aces",
      doc = "Curve. aces: filmic contrast, bright colours turn white. neutral: Hable's curve, white at 4, hues kept. reinhard: x/(1+x), soft and flat." },
  },
  active = function(s) return s.mode ~= "none", "mode is none" end,
  holds = {
    "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    monotone = { within = by_curve(1e-2, 1e-5) },
    bounded = { from = by_curve(-1e-4, 0), to = 1.21, when = function(s) return s.mode ~= "none" end },
    continuous = 1.1, error = { fp32 = by_curve(3e-5, 1e-5) },
  },
  build = function(g, s, source) return g:pass { shader = "tone_mapping/" .. s.mode, source = source, name = s.mode } end,
}
