-- SPDX-License-Identifier: MIT
-- White balance: the picture as if it had been lit by another white, by von Kries adaptation in CAT02's cone space. Temperature and tint
-- move the white along and across the daylight locus as in Unity (ColorUtils.ColorBalanceToLMSCoeffs). All of it is one matrix.
local fx = require "afterglow"

-- Linear Rec.709 (D65) to the cones of CAT02, and back; digits as in Unity's Color.hlsl.
local kToCones = { { 0.390405, 0.549941, 0.00892632 }, { 0.0708416, 0.963172, 0.00135775 }, { 0.0231082, 0.128021, 0.936245 } }
local kFromCones = { { 2.85847, -1.62879, -0.0248910 }, { -0.210182, 1.15820, 0.000324281 }, { -0.0418120, -0.118169, 1.06867 } }
local kWhite = { 0.949237, 1.03542, 1.08728 }  -- D65 in cones

-- The cones' answer to the white that counts as neutral: ±100 reach about as far as film does.
local function cones_of_white(temperature, tint)
  local warm, green = temperature / 65, tint / 65
  local x = 0.31271 - warm * (warm < 0 and 0.1 or 0.05)
  local y = 2.87 * x - 3 * x * x - 0.27509507 + green * 0.05  -- the daylight locus (Judd), through D65
  local X, Z = x / y, (1 - x - y) / y
  return { 0.7328 * X + 0.4296 - 0.1624 * Z, -0.7036 * X + 1.6975 + 0.0061 * Z, 0.0030 * X + 0.0136 + 0.9834 * Z }
end

return fx.effect {
  name = "white_balance",
  doc = "Takes a colour cast away or adds one: temperature and tint.",
  at = "post_process", order = 150, space = "scene",
  settings = {
    temperature = fx.float { min = -100, max = 100, default = 0, doc = "Above 0 warmer (yellow), below 0 colder (blue)." },
    tint = fx.float { min = -100, max = 100, default = 0, doc = "Above 0 towards magenta, below 0 towards green." },
  },
  active = function(s) return s.temperature ~= 0 or s.tint ~= 0, "all settings are neutral" end,

  holds = { "black", "constant", "mirror", "turn_180", "turn_90", shift = 1, continuous = 20,
    -- Rows of the matrix are differences: a dark channel beside a bright one has the digits of the bright one.
    error = { fp32 = 1e-4, up_to = 60 } },
  build = function(g, s, source)
    local cones = cones_of_white(s.temperature, s.tint)
    local rows = {}
    for i = 1, 3 do
      rows[i] = { 0, 0, 0 }
      for j = 1, 3 do
        for k = 1, 3 do rows[i][j] = rows[i][j] + kFromCones[i][k] * (kWhite[k] / cones[k]) * kToCones[k][j] end
      end
    end
    return g:pass { shader = "channel_mixer/mix", source = source, red = rows[1], green = rows[2], blue = rows[3], name = "adapt" }
  end,
}
