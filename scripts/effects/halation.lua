-- SPDX-License-Identifier: MIT
-- Halation: the red glow around highlights on film. Light that passes through the emulsion is thrown back by the film's base and exposes the
-- red-sensitive layer, which lies deepest, once more, whatever the colour of the light; green gets less of it and blue hardly any. The glow falls off as e^(−r/radius), narrower for
-- green and blue (measurements of the point spread of film with and without backing are in J. S. Courtney-Pratt and others; the looks of film stocks
-- are those of Dehancer's and FilmBox's halation tools).
local fx = require "afterglow"
local glow = require "lib.glow"

local function is_bounded(s) return s.intensity * math.max(s.color[1], s.color[2], s.color[3]) <= 100 end
local function digits(s) return 2e-5 * math.max(1, s.intensity) * math.max(1, s.threshold) end

return fx.effect {
  name = "halation",
  doc = "The red and orange glow around highlights on film.",
  at = "post_process", order = 105, space = "scene",
  settings = {
    intensity = fx.float { min = 0, max = 100, default = 0.18, doc = "Share of the light that comes back through the film. 0: none." },
    radius = fx.float { min = 0.5, max = 500, default = 14, unit = "px", doc = "Distance over which red falls to a third (1/e); green 0.6 and blue 0.4 of it. It grows from 2 px up to about a fifth of the height." },
    threshold = fx.float { min = 0, max = 1e6, default = 1, doc = "Brightness (largest channel) from which light comes back; linear." },
    clamp = fx.float { min = 0, max = 1e6, default = 20, doc = "No light counts for more than this: film is exposed fully at some point; linear." },
    color = fx.color { default = { 1, 0.28, 0.06 }, doc = "How much each layer of the film gets of it." },
    source_color = fx.float { min = 0, max = 1, default = 0, doc = "How much the glow takes the light's own colour. 0: light of any colour reaches the red layer first, and cyan signs glow red, as on film. 1: cyan signs glow green." },
  },
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    if s.clamp <= s.threshold then return false, "clamp is not above threshold" end
    return s.color[1] > 0 or s.color[2] > 0 or s.color[3] > 0, "color is black"
  end,
  idle = function(s) return { brightest = s.threshold * (1 - 1e-6) } end,
  -- Taking the threshold from light leaves as many digits less as it is high.
  holds = {
    "black", "constant", mirror = { within = digits, when = is_bounded }, turn_180 = { within = digits, when = is_bounded }, turn_90 = { within = digits, when = is_bounded },
    continuous = function(s) return 1 + 1.1 * s.intensity * math.max(s.color[1], s.color[2], s.color[3]) end,
    error = { fp32 = digits, fp16 = function(s) return 3e-3 * math.max(1, s.threshold) * math.max(1, s.intensity) end, up_to = 1e4,
              when = is_bounded },
  },
  build = function(g, s, source)
    local weights = glow.exponential(source, g.length_scale, { s.radius, 0.6 * s.radius, 0.4 * s.radius })
    local light = glow.of(g, source, g.length_scale, weights, function(width, height) return glow.bright(g, source, width, height, s.threshold, s.clamp, s.source_color) end)
    local tint = {}
    for i = 1, 3 do tint[i] = math.min(s.color[i] * s.intensity, 1e6) end
    return g:pass { shader = "glow/tint", source = light, picture = source, tint = tint, name = "final" }
  end,
}
