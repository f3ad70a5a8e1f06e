-- SPDX-License-Identifier: MIT
-- Film grain: noise that is strongest in the darks, another pattern for each frame and the same one whenever that frame is made. Response to
-- luminance as in Unity (HDRP and URP); the noise is computed instead of read from scans.
local fx = require "afterglow"

-- As shaders/lib/noise.glsl.
local function word_of(x)
  x = ((x ~ x >> 16) * 0x7feb352d) & 0xffffffff
  x = ((x ~ x >> 15) * 0x846ca68b) & 0xffffffff
  return x ~ x >> 16
end

return fx.effect {
  name = "film_grain",
  doc = "Grain of film: fine noise, new in each frame; best after tone mapping.",
  at = "after_post_process", order = 140, space = "display", alpha = "straight",
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.3, doc = "Strength; at 1 the grain of blacks is a quarter of their light. 0: none." },
    response = fx.float { min = 0, max = 1, default = 0.8, doc = "How much less grain there is in bright places: 0 equally much, 1 none in white." },
    size = fx.float { min = 1, max = 16, default = 1, unit = "px", doc = "Size of a grain." },
    colored = fx.float { min = 0, max = 1, default = 0, doc = "0: grey grain as of black-and-white film. 1: each channel has its own." },
    seed = fx.int { min = 0, default = 0, doc = "Another number, other grain." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  holds = { "black", error = { fp32 = function(_, source) return 1e-5 * math.max(1, source.width / 4096, source.height / 4096) end } },
  build = function(g, s, source)
    local size = math.max(1, s.size)  -- a preview cannot show finer grain
    local cell = size * math.sqrt(2 / 3)  -- B-splines are wider than their cells: as wide as tents over cells of that size
    local whole = math.floor(cell * 64) / 64
    local coarse = math.min((size - 1) * 2, 1)  -- grain of a pixel each gives way to it, so that nothing jumps
    local key = word_of(word_of(s.seed) + (math.tointeger(math.floor(g.frame)) or 0) & 0xffffffff)
    return g:pass { shader = "film_grain/grain", source = source, strength = 0.25 * s.intensity, response = s.response,
                    size_of_grain = { whole, cell - whole }, colored = s.colored, key = key & 0x7fffffff, shift = { (key >> 24) / 16, (key >> 16 & 255) / 16 }, coarse = coarse, is_fine = coarse < 1, is_coarse = coarse > 0, grey = s.colored == 0 }
  end,
}
