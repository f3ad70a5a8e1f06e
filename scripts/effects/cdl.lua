-- SPDX-License-Identifier: MIT
-- CDL: the Color Decision List of the American Society of Cinematographers (v1.2): slope, offset and power for each channel, then
-- saturation around Rec.709's luma. It is how looks travel between set, edit and grading. On scene-linear light there is no white to
-- hold on to: values above 1 stay what they are; below 0 is black. The numbers of a file do what the same settings do, and come first; the
-- settings are behind them.
local fx = require "afterglow"

local of_cdl = 5  -- the kind of a step: engine/image/lut_file.h

local function all(v, value) return v[1] == value and v[2] == value and v[3] == value end
local function least(v) return math.min(v[1], v[2], v[3]) end
local function most(v) return math.max(v[1], v[2], v[3]) end
-- Numbers below 1.2e-38 may count as 0.
local function none_is_tiny(v)
  for i = 1, 3 do
    if v[i] ~= 0 and v[i] < 1e-30 then return false end
  end
  return true
end
local function neutral(s) return all(s.slope, 1) and all(s.offset, 0) and all(s.power, 1) and s.saturation == 1 end

return fx.effect {
  name = "cdl",
  doc = "Slope, offset, power and saturation of an ASC CDL.",
  at = "post_process", order = 185, space = "scene", alpha = "straight",
  settings = {
    file = fx.file { extensions = { "cc", "ccc", "cdl" }, doc = "A correction in a file, beside the preset or on the search path. None: the settings alone." },
    correction = fx.text { default = "", doc = "Of a file with several corrections (.ccc, .cdl) the id of the one, or its number from 0; empty: the first." },
    slope = fx.vec3 { min = 0, max = 16, default = { 1, 1, 1 }, doc = "Light times this; shows most in the brights." },
    offset = fx.vec3 { min = -4, max = 4, default = { 0, 0, 0 }, doc = "Added behind it; shows most in the darks." },
    power = fx.vec3 { min = 0.1, max = 10, default = { 1, 1, 1 }, doc = "The power taken of the sum: above 1 darkens what is below 1." },
    saturation = fx.float { min = 0, max = 4, default = 1, doc = "Distance from luma: 0 grey, 1 as it is." },
  },
  active = function(s)
    return s.file ~= "" or not neutral(s), "all settings are neutral"
  end,
  -- A power multiplies the rounding of what it is given; an offset rounds as what it is added to and takes away; a root makes much of what little
  -- that leaves. Saturation above 1 takes the luma of strong powers from one of its channels: no digit need be left of that.
  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1,
    black = { when = function(s) return s.file == "" and most(s.offset) <= 0 end },
    monotone = { when = function(s) return s.file == "" and s.saturation <= 1 end },
    error = { fp32 = function(s)
                return 1e-5 * math.max(1, most(s.power)) * math.max(1, most(s.offset), -least(s.offset))
              end, up_to = 60,
              when = function(s) return s.file == "" and s.saturation <= 1 and none_is_tiny(s.slope) and (least(s.offset) >= 0 or least(s.power) >= 1) end } },
  build = function(g, s, source)
    if s.file ~= "" then
      local lookup = g:lookup { file = s.file, correction = s.correction }
      for _, step in ipairs(lookup.steps) do
        if step.kind ~= of_cdl then error('file = "' .. s.file .. '" holds a table; effect \'lut\' reads those', 0) end
        source = g:pass { shader = "cdl/file", source = source, table = lookup.table, row = step.row, name = "file" }
      end
    end
    if neutral(s) then return source end
    return g:pass { shader = "cdl/grade", source = source, slope = s.slope, offset = s.offset, power = s.power, saturation = s.saturation,
                    use_power = not all(s.power, 1) }
  end,
}
