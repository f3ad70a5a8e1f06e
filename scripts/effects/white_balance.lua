-- SPDX-License-Identifier: MIT
-- White balance: the picture as if it had been lit by another white, by von Kries adaptation in CAT02's cone space. The white is that of a
-- light of so many kelvins; temperature and tint move it along and across the daylight locus as in Unity (ColorUtils.ColorBalanceToLMSCoeffs).
-- All of it is one matrix. math.md §41.
local fx = require "afterglow"

-- Linear Rec.709 (D65) to the cones of CAT02, and back; digits as in Unity's Color.hlsl.
local kToCones = { { 0.390405, 0.549941, 0.00892632 }, { 0.0708416, 0.963172, 0.00135775 }, { 0.0231082, 0.128021, 0.936245 } }
local kFromCones = { { 2.85847, -1.62879, -0.0248910 }, { -0.210182, 1.15820, 0.000324281 }, { -0.0418120, -0.118169, 1.06867 } }
local kWhite = { 0.949237, 1.03542, 1.08728 }  -- D65 in cones

local kNeutral = 6504  -- kelvins of D65
local kX = 0.31271     -- its x
local kMost = 16       -- times that a cone's answer is enlarged; settings at their ends together would lead out of all colours

-- y on the daylight locus (Judd), through D65.
local function daylight(x) return 2.87 * x - 3 * x * x - 0.27509507 end

-- Chromaticity of a lamp that glows (Planck), as Kim et al. have it (US patent 7024034), to 4000 K.
local function glowing(kelvin)
  local t = 1000 / kelvin
  local x = 0.179910 + t * (0.8776956 + t * (-0.2343589 - 0.2661239 * t))
  if kelvin < 2222 then return x, -0.20219683 + x * (2.18555832 + x * (-1.34811020 - 1.1063814 * x)) end
  return x, -0.16748867 + x * (2.09137015 + x * (-1.37418593 - 0.9549476 * x))
end

-- x of daylight (CIE 15), below 4000 K continued.
local function x_of_daylight(kelvin)
  local t = 1000 / kelvin
  if kelvin <= 7000 then return 0.244063 + t * (0.09911 + t * (2.9678 - 4.6070 * t)) end
  return 0.237040 + t * (0.24748 + t * (1.9018 - 2.0064 * t))
end

-- Up to 2900 K a lamp, from 4000 K daylight, and between mixed by their mireds. 6504 K is D65.
local function white_of(kelvin)
  local x = x_of_daylight(kelvin) - x_of_daylight(kNeutral) + kX
  local y = daylight(x)
  local lamp = (1 / kelvin - 1 / 4000) / (1 / 2900 - 1 / 4000)
  if lamp <= 0 then return x, y end
  local lamp_x, lamp_y = glowing(kelvin)
  lamp = math.min(lamp, 1)
  return x + (lamp_x - x) * lamp, y + (lamp_y - y) * lamp
end

-- The cones' answer to the white that counts as neutral: ±100 reach about as far as film does.
local function cones_of_white(s)
  local warm, green = s.temperature / 65, s.tint / 65
  local from_x, from_y = white_of(s.kelvin)
  local x = from_x - warm * (warm < 0 and 0.1 or 0.05)
  local y = from_y + daylight(x) - daylight(from_x) + green * 0.05
  local X, Z = x / y, (1 - x - y) / y
  return { 0.7328 * X + 0.4296 - 0.1624 * Z, -0.7036 * X + 1.6975 + 0.0061 * Z, 0.0030 * X + 0.0136 + 0.9834 * Z }
end

return fx.effect {
  name = "white_balance",
  doc = "Takes a colour cast away or adds one: kelvins of the light, temperature and tint.",
  at = "post_process", order = 150, space = "scene",
  settings = {
    kelvin = fx.float { min = 2000, max = 25000, default = kNeutral, unit = "K",
      doc = "Colour temperature of the light in which the picture was taken: what it makes of white becomes white. Lamps have 2700 to 3200, the sun at noon 5500, shade 7500; 6504 (D65) changes nothing." },
    temperature = fx.float { min = -100, max = 100, default = 0, doc = "Above 0 warmer (yellow), below 0 colder (blue)." },
    tint = fx.float { min = -100, max = 100, default = 0, doc = "Above 0 towards magenta, below 0 towards green." },
  },
  active = function(s) return s.kelvin ~= kNeutral or s.temperature ~= 0 or s.tint ~= 0, "all settings are neutral" end,

  holds = { "black", "constant", "mirror", "turn_180", "turn_90", shift = 1, continuous = 20,
    -- Rows of the matrix are differences: a dark channel beside a bright one has the digits of the bright one.
    error = { fp32 = 1e-4, up_to = 60 } },
  build = function(g, s, source)
    local cones = cones_of_white(s)
    local rows = {}
    for i = 1, 3 do
      rows[i] = { 0, 0, 0 }
      for j = 1, 3 do
        for k = 1, 3 do rows[i][j] = rows[i][j] + kFromCones[i][k] * (kWhite[k] / math.max(cones[k], kWhite[k] / kMost)) * kToCones[k][j] end
      end
    end
    return g:pass { shader = "channel_mixer/mix", source = source, red = rows[1], green = rows[2], blue = rows[3], name = "adapt" }
  end,
}
