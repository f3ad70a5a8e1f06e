-- SPDX-License-Identifier: MIT
-- Split toning: one tint for the shadows and another for the highlights, by soft light in gamma space, as Unity and photographers' programs
-- do it, but for light above 1, which Unity's formula turns to the opposite
-- tint: here it stays. Middle grey (#808080) is neutral.
local fx = require "afterglow"

local kGrey = 0.21404114  -- linear value of the display value 0.5

-- Display value 0…1 of linear light.
local function encoded(c)
  local out = {}
  for i = 1, 3 do
    local v = math.min(c[i], 1)
    v = v <= 0.0031308 and 12.92 * v or 1.055 * v ^ (1 / 2.4) - 0.055
    -- 0x80 of 8 bits is 0.502: it is meant to be the middle. (The default has eight digits.)
    local is_middle = math.abs(v - 0.5) < 1e-6 or math.abs(v - 128 / 255) < 1e-6
    out[i] = is_middle and 0.5 or v
  end
  return out
end

-- How far a tint is from grey: 1 is black, -1 white.
local function from_grey(c)
  local e = encoded(c)
  return { 1 - 2 * e[1], 1 - 2 * e[2], 1 - 2 * e[3] }
end

local function is_grey(c) return c[1] == 0.5 and c[2] == 0.5 and c[3] == 0.5 end

return fx.effect {
  name = "split_toning",
  doc = "Tints shadows and highlights in colours of their own; white and what is brighter stays.",
  at = "post_process", order = 155, space = "scene", alpha = "straight",
  settings = {
    shadows = fx.color { default = { kGrey, kGrey, kGrey }, doc = "Tint of the shadows; #808080 leaves them alone." },
    highlights = fx.color { default = { kGrey, kGrey, kGrey }, doc = "Tint of the highlights; #808080 leaves them alone." },
    balance = fx.float { min = -100, max = 100, default = 0, unit = "%", doc = "Above 0 more of the picture counts as highlights, below 0 as shadows." },
  },
  active = function(s) return not (is_grey(encoded(s.shadows)) and is_grey(encoded(s.highlights))), "both tints are grey" end,
  holds = { "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    "error" },
  build = function(g, s, source)
    return g:pass { shader = "split_toning/tint", source = source,
                    shadows = from_grey(s.shadows), highlights = from_grey(s.highlights), balance = s.balance / 100 }
  end,
}
