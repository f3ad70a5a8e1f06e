-- SPDX-License-Identifier: MIT
-- Shadows, midtones, highlights: a factor for each, shared out by luminance, as Unity's component of that name has it.
local fx = require "afterglow"

local function tint(of) return fx.color { default = { 1, 1, 1 }, doc = ("Colour by which %s are multiplied."):format(of) } end
local function offset(of)
  return fx.float { min = -1, max = 1, default = 0, doc = ("Added to the factor of %s; four times as much above 0, so that 1 is plenty of light and -1 black."):format(of) }
end
local function limit(default, doc) return fx.float { min = 0, max = 100, default = default, doc = doc } end

local function factor(color, add)
  add = add * (add < 0 and 1 or 4)
  local out = {}
  for i = 1, 3 do out[i] = math.min(math.max(color[i] + add, 0), 1e6) end
  return out
end

local function is_white(c) return c[1] == 1 and c[2] == 1 and c[3] == 1 end

-- smoothstep needs limits that differ, in 32 bits too.
local function beyond(limit, start) return math.max(limit, start * 1.0001 + 1e-5) end

-- At an edge that is nearly hard, rounding decides on which side a pixel is.
local function is_soft(start, limit) return limit - start >= 0.02 * limit end

-- Where shadows and highlights overlap, midtones count below 0: factors cancel.
local function is_bounded(s)
  return s.shadows_end <= s.highlights_start and is_soft(s.shadows_start, s.shadows_end) and is_soft(s.highlights_start, s.highlights_end)
end

local function brightest(s)
  local most = 0
  for _, color in ipairs { s.shadows, s.midtones, s.highlights } do most = math.max(most, color[1], color[2], color[3]) end
  return most
end

return fx.effect {
  name = "shadows_midtones_highlights",
  doc = "Colours and brightens shadows, midtones and highlights, each by itself.",
  at = "post_process", order = 170, space = "scene", alpha = "straight",
  settings = {
    shadows = tint("shadows"), shadows_offset = offset("shadows"),
    midtones = tint("midtones"), midtones_offset = offset("midtones"),
    highlights = tint("highlights"), highlights_offset = offset("highlights"),
    shadows_start = limit(0, "Luminance from which shadows fade into midtones."),
    shadows_end = limit(0.3, "Luminance from which nothing counts as shadow. Not above the start: a hard edge there."),
    highlights_start = limit(0.55, "Luminance from which midtones fade into highlights."),
    highlights_end = limit(1, "Luminance from which all is highlight. Not above the start: a hard edge there."),
  },
  active = function(s)
    return not (is_white(factor(s.shadows, s.shadows_offset)) and is_white(factor(s.midtones, s.midtones_offset))
                and is_white(factor(s.highlights, s.highlights_offset))), "all factors are 1"
  end,
  holds = { "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    error = { fp32 = 2e-4, when = function(s) return brightest(s) <= 1e5 and is_bounded(s) end } },
  build = function(g, s, source)
    return g:pass {
      shader = "shadows_midtones_highlights/scale", source = source,
      shadows = factor(s.shadows, s.shadows_offset), midtones = factor(s.midtones, s.midtones_offset),
      highlights = factor(s.highlights, s.highlights_offset),
      shadow_limits = { s.shadows_start, beyond(s.shadows_end, s.shadows_start) },
      highlight_limits = { s.highlights_start, beyond(s.highlights_end, s.highlights_start) },
    }
  end,
}
