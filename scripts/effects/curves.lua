-- SPDX-License-Identifier: MIT
-- Curves: tone by brightness, for all channels or each, and hue, saturation and luma by hue. A tone curve is a gain in stops through
-- five points on the scale of stops from middle grey (0.18): blacks −6, shadows −3, midtones 0, highlights +3, whites +6; it goes on flat
-- beyond them. So it works on light of any brightness, and black stays black. Between the points: cubic pieces whose slopes are the harmonic
-- means of the neighbouring ones (F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic interpolants, 1984): no
-- overshoot. The curves over hue go through six points, 60° apart, by smoothsteps.
local fx = require "afterglow"

local kHues = { "reds", "yellows", "greens", "cyans", "blues", "magentas" }

-- Slopes at the five points: 0 at the ends and where the curve turns.
local function slopes(y)
  local out = { 0, 0, 0, 0, 0 }
  for i = 2, 4 do
    local before, behind = y[i] - y[i - 1], y[i + 1] - y[i]
    if before * behind > 0 then out[i] = 2 * before * behind / (before + behind) end
  end
  return out
end

-- The parameters of shader "curves/tone" for curves[channel][point].
local function tone(curves)
  local parameters = {}
  for channel = 1, 3 do
    local y = curves[channel]
    local slope = slopes(y)
    for i = 1, 5 do
      parameters["y" .. i] = parameters["y" .. i] or {}
      parameters["y" .. i][channel] = y[i]
      parameters["m" .. i] = parameters["m" .. i] or {}
      parameters["m" .. i][channel] = slope[i]
    end
  end
  parameters.m1, parameters.m5 = nil, nil
  return parameters
end

local function master(s) return { s.blacks, s.shadows, s.midtones, s.highlights, s.whites } end
-- Three points stand for five: shadows hold for what is darker too, highlights for what is brighter.
local function of_channel(v) return { v[1], v[1], v[2], v[3], v[3] } end

local function all_zero(values)
  for _, v in ipairs(values) do
    if v ~= 0 then return false end
  end
  return true
end
local function has_master(s) return not all_zero(master(s)) end
local function has_channels(s) return not (all_zero(s.red) and all_zero(s.green) and all_zero(s.blue)) end
local function has_hues(s)
  for _, name in ipairs(kHues) do
    if not all_zero(s[name]) then return true end
  end
  return false
end

-- The largest change of two neighbouring points, in stops: how steep the curves are.
local function steepest(s)
  local most = 0
  for _, y in ipairs { master(s), of_channel(s.red), of_channel(s.green), of_channel(s.blue) } do
    for i = 1, 4 do most = math.max(most, math.abs(y[i + 1] - y[i])) end
  end
  return most
end

-- The largest gain that can be, in stops.
local function most(s)
  local all, channel = math.max(0, table.unpack(master(s))), 0
  for _, v in ipairs { s.red, s.green, s.blue } do channel = math.max(channel, v[1], v[2], v[3]) end
  return all + channel
end

local function hue_doc(name) return "Hue, saturation and luma of " .. name .. ": degrees / 0.3, percent, percent of a stop. Greys stay." end

local function point(where) return fx.float { min = -4, max = 4, default = 0, unit = "EV", doc = "Gain at " .. where .. "." } end
local function channel(name)
  return fx.vec3 { min = -4, max = 4, default = { 0, 0, 0 }, unit = "EV", doc = "Gain of " .. name .. " in shadows, midtones and highlights." }
end
local function hue(name) return fx.vec3 { min = -100, max = 100, default = { 0, 0, 0 }, unit = "%", doc = hue_doc(name) } end

return fx.effect {
  name = "curves",
  doc = "Tone curves for all channels and each, and hue, saturation and luma by hue.",
  at = "post_process", order = 187, space = "scene", alpha = "straight",
  settings = {
    by = fx.enum { "channels", "luminance", default = "channels",
      doc = "What the five points look at. channels: each channel's own light, as film does; contrast adds colour. luminance: the colour as a whole; hues stay." },
    blacks = point "six stops below middle grey, and below that", shadows = point "three stops below middle grey",
    midtones = point "middle grey (0.18)", highlights = point "three stops above middle grey (1.44)",
    whites = point "six stops above middle grey (11.5), and above that",
    red = channel "red", green = channel "green", blue = channel "blue",
    reds = hue "reds", yellows = hue "yellows", greens = hue "greens", cyans = hue "cyans", blues = hue "blues", magentas = hue "magentas",
  },
  active = function(s) return has_master(s) or has_channels(s) or has_hues(s), "all points are 0" end,
  holds = { "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    -- Gains of up to 16, each with its own rounding; hues of greys that differ by roundings differ, by as little as their colours do.
    -- More saturation takes bright channels from dark ones, by their gain too.
    error = { fp32 = function(s) return (5e-5 + 2e-5 * steepest(s)) * (has_hues(s) and 4 * 2 ^ most(s) or 1) end, up_to = 60 } },
  build = function(g, s, source)
    local image = source
    local function run(curves, luminance, name)
      local parameters = tone(curves)
      parameters.shader, parameters.source, parameters.together, parameters.name = "curves/tone", image, luminance, name
      image = g:pass(parameters)
    end
    if has_master(s) and s.by == "luminance" then run({ master(s), master(s), master(s) }, true, "luminance") end
    local together = {}
    for i, v in ipairs { s.red, s.green, s.blue } do
      together[i] = of_channel(v)
      if s.by == "channels" then
        for point, gain in ipairs(master(s)) do together[i][point] = together[i][point] + gain end
      end
    end
    if not (all_zero(together[1]) and all_zero(together[2]) and all_zero(together[3])) then run(together, false, "channels") end
    if has_hues(s) then
      local parameters = { shader = "curves/hues", source = image, name = "hues" }
      for i, name in ipairs(kHues) do
        local v = s[name]
        parameters["h" .. i] = { v[1] * 0.005, v[2] * 0.01, v[3] * 0.01 }  -- sextants, shares, stops
      end
      image = g:pass(parameters)
    end
    return image
  end,
}
