-- SPDX-License-Identifier: MIT
-- Channel mixer: each channel of the result is a weighted sum of the picture's, as in Unity, Photoshop and film printing.
local fx = require "afterglow"

local function share(default, from, to)
  return fx.float { min = -200, max = 200, default = default, unit = "%", doc = ("How much of %s goes into %s."):format(from, to) }
end

local function rows(s)
  return {
    { s.red_out_red_in, s.red_out_green_in, s.red_out_blue_in },
    { s.green_out_red_in, s.green_out_green_in, s.green_out_blue_in },
    { s.blue_out_red_in, s.blue_out_green_in, s.blue_out_blue_in },
  }
end

local function subtracts(s)
  for _, row in ipairs(rows(s)) do
    if math.min(row[1], row[2], row[3]) < 0 then return true end
  end
  return false
end

return fx.effect {
  name = "channel_mixer",
  doc = "Mixes red, green and blue into new channels; what would be negative is black.",
  at = "post_process", order = 160, space = "scene",
  settings = {
    red_out_red_in = share(100, "red", "red"), red_out_green_in = share(0, "green", "red"), red_out_blue_in = share(0, "blue", "red"),
    green_out_red_in = share(0, "red", "green"), green_out_green_in = share(100, "green", "green"), green_out_blue_in = share(0, "blue", "green"),
    blue_out_red_in = share(0, "red", "blue"), blue_out_green_in = share(0, "green", "blue"), blue_out_blue_in = share(100, "blue", "blue"),
  },

  active = function(s)
    for i, row in ipairs(rows(s)) do
      for j, percent in ipairs(row) do
        if percent ~= (i == j and 100 or 0) then return true end
      end
    end
    return false, "all settings are neutral"
  end,

  holds = {
    "black", "constant", "mirror", "turn_180", "turn_90", shift = 1,
    continuous = 6,
    linear = { when = function(s) return not subtracts(s) end },
    -- What is left of a difference has the error of its terms.
    error = { fp32 = function(s) return subtracts(s) and 2e-3 or 1e-5 end, up_to = function(s) return subtracts(s) and 50 or 1e6 end },
  },
  build = function(g, s, source)
    local m = rows(s)
    for _, row in ipairs(m) do
      for j = 1, 3 do row[j] = row[j] / 100 end
    end
    return g:pass { shader = "channel_mixer/mix", source = source, red = m[1], green = m[2], blue = m[3] }
  end,
}
