-- SPDX-License-Identifier: MIT
-- Tone mapping: one curve per look, chosen by name. Everything before it is scene-linear light, everything behind it is the light of a display,
-- 0 to 1. docs/tone_mapping.md shows what each curve does to greys and to saturated colours, with its source.
local fx = require "afterglow"

local curves = {
  none = {},
  aces = { white = 0.9453927501, slope = 1.1, to = 1.21 },
  neutral = { slope = 1.1, to = 1.21 },
  reinhard = { white = 60 / 61, slope = 1.1, to = 1.21 },
  reinhard_extended = { slope = 1.1 }, agx = { slope = 1.1, to = 1 }, khronos_neutral = { slope = 1.1, to = 1 }, hable = { to = 1 },
  gt = { slope = 1.25, to = 1 },
}

local looks = { base = 0, punchy = 1, golden = 2 }

-- The published ACES transform dips below black where greys are below 1e-4, and sums channels of both signs.
local function by_curve(aces, other) return function(s) return s.mode == "aces" and aces or other end end

-- Hable's user parameters to the three pieces, in light over white (FilmicToneCurve.cpp: CalcDirectParamsFromUser, CreateCurve).
local function hable(s)
  local x0 = s.toe_length ^ 2.2 * 0.5
  local y0 = (1 - s.toe) * x0
  local rest = 1 - y0
  local length = math.max(1e-5, s.shoulder_length)
  local straight = (1 - length) * rest
  local x1, y1 = x0 + straight, y0 + straight
  local least = x0 + rest                       -- white without a shoulder
  local white = math.max(s.white, least)
  local stops = math.log(white - least + 1, 2)  -- the shoulder's strength
  local end_x = 1 + 2 * s.shoulder_angle * stops
  local end_y = 1 + 0.5 * s.shoulder_angle * stops
  local slope = white                           -- of the line, in light over white; it is 1 in light
  x0, x1 = x0 / white, x1 / white
  local start = y0 - slope * x0
  y0, y1 = math.max(1e-5, y0), math.max(1e-5, y1)
  local height = end_y - y1
  local power = slope * (end_x - x1) / height
  local at_white = end_y - height * ((end_x - 1) / (end_x - x1)) ^ power
  return {
    inverse_white = 1 / white, joints = { x0, x1 }, toe = { y0, slope * x0 / y0 }, line = { slope, start },
    shoulder = { end_x, y1, height, power }, scale = 1 / at_white,
  }
end

return fx.effect {
  name = "tone_mapping",
  doc = "Brings scene-linear light into display range.",
  at = "post_process", order = 200, space = { needs = "scene", makes = "display" }, alpha = "straight",
  settings = {
    mode = fx.enum { "none", "aces", "neutral", "reinhard", "reinhard_extended", "agx", "khronos_neutral", "hable", "gt", default = "aces",
      doc = "Curve. aces: filmic contrast, bright colours turn white. neutral: Hable's curve as Unity has it, white at 4. reinhard: x/(1+x), soft and flat. reinhard_extended: on luminance, with a white point. agx: bright saturated light bleaches as on film. khronos_neutral: base colours stay, for products. hable: a toe, a line and a shoulder of one's own. gt: light around middle grey stays as it is." },
    exposure = fx.float { min = -16, max = 16, default = 0, unit = "EV", doc = "Light times 2^exposure before the curve; bloom and other effects before it do not see it. With the curve none nothing is done." },
    white = fx.float { min = 0.5, max = 1000, default = 8, doc = "reinhard_extended, hable: the light that becomes white (hable: at least about 1)." },
    full_white = fx.bool { default = false, doc = "aces, reinhard: their brightest white is 0.945 and 0.984 of the display's; this makes it 1." },
    look = fx.enum { "base", "punchy", "golden", default = "base", doc = "agx: base as it is, punchy with more contrast and colour, golden warm and light." },
    toe = fx.float { min = 0, max = 0.95, default = 0.25, doc = "hable: how dark the darks get. 0: a straight line." },
    toe_length = fx.float { min = 0, max = 1, default = 0.5, doc = "hable: how much of the darks the toe takes." },
    shoulder_length = fx.float { min = 0, max = 1, default = 0.6, doc = "hable: how much of the display's range is left to the brights." },
    shoulder_angle = fx.float { min = 0, max = 1, default = 0.2, doc = "hable: above 0 the shoulder is still rising at white, as of film that has more to give." },
  },
  active = function(s) return s.mode ~= "none", "mode is none" end,
  holds = {
    "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    monotone = { within = by_curve(2e-2, 1e-5) },
    bounded = { from = by_curve(-1e-4, 0), to = function(s)
                  local curve = s.mode == "hable" and hable(s)  -- with an angle its shoulder goes on beyond white
                  return curve and (curve.shoulder[2] + curve.shoulder[3]) * curve.scale or curves[s.mode].to or 1
                end,
                when = function(s) return s.mode ~= "none" and curves[s.mode].to ~= nil end },
    continuous = { slope = function(s)  -- reinhard_extended rises without end, in brights by 1/white²
                     return math.max(curves[s.mode].slope or 1, s.mode == "reinhard_extended" and 1.01 / s.white ^ 2 or 0) * 2 ^ s.exposure
                   end,
                   when = function(s) return s.mode ~= "none" and curves[s.mode].slope ~= nil and (s.mode ~= "agx" or s.look == "base") end },
    error = { fp32 = function(s) return (s.mode == "aces" or s.mode == "agx") and 5e-5 or 2e-5 end },
  },
  build = function(g, s, source)
    local pass = { shader = "tone_mapping/" .. s.mode, name = s.mode }
    if s.mode == "hable" then
      for name, value in pairs(hable(s)) do pass[name] = value end
    elseif s.mode == "reinhard_extended" then
      pass.inverse_white = 1 / s.white
    elseif s.mode == "agx" then
      pass.look = looks[s.look]
    end
    if s.exposure ~= 0 then source = g:pass { shader = "exposure/expose", source = source, factor = 2.0 ^ s.exposure, name = "exposure" } end
    pass.source = source
    local image = g:pass(pass)
    local white = curves[s.mode].white
    if s.full_white and white then image = g:pass { shader = "exposure/expose", source = image, factor = 1 / white, name = "full_white" } end
    return image
  end,
}
