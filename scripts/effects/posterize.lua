-- SPDX-License-Identifier: MIT
-- Posterize: light in few steps, as in cartoons and screen prints. The steps are even to the eye (of √luminance), each with an edge of its own softness, and the colour
-- keeps its hue: its channels are scaled together.
local fx = require "afterglow"

return fx.effect {
  name = "posterize",
  doc = "Few flat tones, as in cartoons and prints; after tone mapping.",
  at = "after_post_process", order = 90, space = "display", alpha = "straight",
  settings = {
    levels = fx.int { min = 2, max = 64, default = 5, doc = "Tones from black to white." },
    softness = fx.float { min = 0, max = 1, default = 0.3, doc = "How much of a step is a slope: 0 hard edges, 1 one slope after the other." },
    shadows = fx.float { min = 0, max = 1, default = 0, doc = "Of the first tone above black: up to here dark colours stay as they are. 0: they are black, and dark wood has black blotches." },
    intensity = fx.float { min = 0, max = 1, default = 1, doc = "How much of it is mixed in. 0: none." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  -- No bound on the error where steps are hard: rounding decides on which side of one a colour lies.
  holds = { "black", "mirror", "turn_180", "turn_90", shift = 1, constant = 1e-4,
    error = { fp32 = 2e-3, fp16 = false, up_to = 4, when = function(s) return s.softness >= 0.2 and s.levels <= 16 end } },
  build = function(g, s, source)
    return g:pass { shader = "posterize/step", source = source, steps = s.levels - 1, soft = math.max(s.softness, 1e-3), kept = s.shadows / (s.levels - 1), share = s.intensity }
  end,
}
