-- SPDX-License-Identifier: MIT
-- Glitch: an analogue signal that has come loose. Jitter of scan lines and shaking as in K. Takahashi's KinoGlitch for Unity (AnalogGlitch),
-- with its scales; random numbers come from the frame and the seed alone, and shifts are whole pixels.
local fx = require "afterglow"

return fx.effect {
  name = "glitch",
  doc = "Scan lines that jump, a shaking picture, colours that part.",
  at = "after_post_process", order = 145,
  settings = {
    scan_line_jitter = fx.float { min = 0, max = 1, default = 0.3, doc = "How many scan lines jump sideways, and how far." },
    line_height = fx.float { min = 1, max = 1024, default = 2, unit = "px", doc = "Height of a scan line." },
    horizontal_shake = fx.float { min = 0, max = 1, default = 0, doc = "How far the whole picture jumps sideways in each frame; 1: up to a tenth of it." },
    rgb_split = fx.float { min = 0, max = 1, default = 0.1, doc = "How far red and blue part; 1: up to a twenty-fifth of the picture each way." },
    vertical_roll = fx.float { min = -30, max = 30, default = 0, unit = "pictures/s", doc = "Speed at which the picture rolls; above 0 upwards." },
    edges = fx.enum { "wrap", "stretch", default = "wrap",
                      doc = "What comes in at the sides. wrap: what goes out at the other side. stretch: the last pixel, again and again." },
    seed = fx.int { min = 0, default = 0, doc = "Another number, another pattern." },
  },
  active = function(s)
    return s.scan_line_jitter > 0 or s.horizontal_shake > 0 or s.rgb_split > 0 or s.vertical_roll ~= 0, "all settings are 0"
  end,
  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1, error = 1e-5 },
  build = function(g, s, source)
    local jitter = s.scan_line_jitter
    return g:pass {
      shader = "glitch/shift", source = source, line_height = s.line_height, frame = (math.tointeger(math.floor(g.frame)) or 0) & 0x7fffffff, seed = s.seed,
      quiet = math.max(1 - 1.2 * jitter, 0), jump = jitter > 0 and 0.002 + 0.05 * jitter ^ 3 or 0,
      shake = 0.2 * s.horizontal_shake, split = 0.04 * s.rgb_split,
      roll = math.floor(source.height * (s.vertical_roll * g.time % 1)) % source.height,
      stretch = s.edges == "stretch",
    }
  end,
}
