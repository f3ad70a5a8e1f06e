-- SPDX-License-Identifier: MIT
-- Lift, gamma, gain: the three wheels of a colourist, with Unity's scales (ColorUtils.PrepareLiftGammaGain). A colour turns a wheel
-- (only its hue and saturation count, white is the middle), the offset beside it turns the ring.
local fx = require "afterglow"

local function wheel(of) return fx.color { default = { 1, 1, 1 }, doc = ("Colour of %s; only its hue and saturation count."):format(of) } end
local function ring(doc) return fx.float { min = -1, max = 1, default = 0, doc = doc } end

-- The wheel's colour without its luminance, times `scale`, plus `base`. Grey gives `base` exactly.
local function turned(color, scale, base)
  local y = (0.2126729 * color[1] + 0.7151522 * color[2] + 0.0721750 * color[3]) / 1.0000001
  if color[1] == color[2] and color[2] == color[3] then y = color[1] end
  local out = {}
  for i = 1, 3 do out[i] = math.max(math.min((color[i] - y) * scale + base, 1e6), -1e6) end
  return out
end

local function values(s)
  local lift = turned(s.lift, 0.15, s.lift_offset)
  local power = turned(s.gamma, 0.8, 1 + s.gamma_offset)
  local gain = turned(s.gain, 0.8, 1 + s.gain_offset)
  for i = 1, 3 do power[i] = 1 / math.max(power[i], 1e-3) end
  return lift, power, gain
end

local function all(c, value) return c[1] == value and c[2] == value and c[3] == value end

local function brightest(s)
  local most = 0
  for _, color in ipairs { s.lift, s.gamma, s.gain } do most = math.max(most, color[1], color[2], color[3]) end
  return most
end

-- How much the lift takes away, at most.
local function taken(s)
  local lift = values(s)
  return math.max(0, -lift[1], -lift[2], -lift[3])
end

-- A power multiplies the relative error of what it is given (3e-7: gain, lift, logarithm), and that grows with what the lift has taken away.
local function rounding(s)
  local _, power = values(s)
  return 1e-5 * math.max(1, math.max(power[1], power[2], power[3]) / 30) * (1 + taken(s))
end

local function least_gain(s)
  local _, _, gain = values(s)
  return math.min(gain[1], gain[2], gain[3])
end

-- A root makes much of the rounding of what a lift has left; a gain below 0 takes away without end.
local function is_bounded(s)
  local _, power = values(s)
  return brightest(s) <= 1e5 and least_gain(s) >= 0 and (taken(s) == 0 or math.min(power[1], power[2], power[3]) >= 1)
end

return fx.effect {
  name = "lift_gamma_gain",
  doc = "The colourist's three wheels: lift for the darks, gamma for the middle, gain for the brights.",
  at = "post_process", order = 180, space = "scene", alpha = "straight",
  settings = {
    lift = wheel("lift"), lift_offset = ring("Light added everywhere; shows most in the darks. What it takes below black is black."),
    gamma = wheel("gamma"), gamma_offset = ring("Above 0 lightens the middle, below 0 darkens it; black and 1 stay, and light above 1 goes the other way."),
    gain = wheel("gain"), gain_offset = ring("Light times 1 + this; shows most in the brights."),
  },
  active = function(s)
    local lift, power, gain = values(s)
    return not (all(lift, 0) and all(power, 1) and all(gain, 1)), "all settings are neutral"
  end,
  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1,
    monotone = { when = function(s) return least_gain(s) >= 0 end },
    error = { fp32 = rounding, when = is_bounded } },
  build = function(g, s, source)
    local lift, power, gain = values(s)
    return g:pass { shader = "lift_gamma_gain/grade", source = source, lift = lift, power = power, gain = gain }
  end,
}
