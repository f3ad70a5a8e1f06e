-- SPDX-License-Identifier: MIT
-- Colour adjustments in the order exposure, contrast, filter, hue, saturation, as Unity's volume component of that name has them.
-- A step that is neutral is not compiled in; when all are, the effect does not run, and does not clamp to 60 either.
local fx = require "afterglow"

local function steps(s)
  local c = s.color_filter
  return {
    exposure = s.post_exposure ~= 0,
    contrast = s.contrast ~= 0,
    filter = c[1] ~= 1 or c[2] ~= 1 or c[3] ~= 1,
    hue = s.hue_shift ~= 0,
    saturation = s.saturation ~= 0,
  }
end

local function bounded(x) return math.max(math.min(x, 1e28), -1e28) end

return fx.effect {
  name = "color_adjustments",
  doc = "Exposure, contrast, colour filter, hue and saturation.",
  at = "post_process", order = 190, space = "scene", alpha = "straight",
  settings = {
    post_exposure = fx.float { default = 0, unit = "EV", doc = "Brightness in stops: light times 2^EV. As with all settings here, light above 60 counts as 60." },
    contrast = fx.float { min = -100, max = 100, default = 0, unit = "%",
      doc = "Contrast around middle grey (linear 0.22), in Alexa LogC space. -100 leaves that grey alone." },
    color_filter = fx.color { default = { 1, 1, 1 }, doc = "Light is multiplied by this; may exceed 1." },
    hue_shift = fx.float { min = -180, max = 180, default = 0, unit = "degrees", doc = "Turns every hue; 120 takes red to green." },
    saturation = fx.float { min = -100, max = 100, default = 0, unit = "%", doc = "-100 leaves luminance (Rec.709) alone, 100 doubles the distance from it." },
  },

  active = function(s)
    for _, needed in pairs(steps(s)) do
      if needed then return true end
    end
    return false, "all settings are neutral"
  end,

  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1, 
    error = { fp32 = 1e-4, fp16 = 1e-2, up_to = 60, when = function(s)
      return math.abs(s.post_exposure) <= 20 and math.max(s.color_filter[1], s.color_filter[2], s.color_filter[3]) <= 1e5
    end },
  },
  build = function(g, s, source)
    local use = steps(s)
    local sextants = s.hue_shift / 60
    local whole = math.floor(sextants + 0.5)
    local c = s.color_filter
    return g:pass {
      shader = "color_adjustments/grade", source = source,
      use_exposure = use.exposure, use_contrast = use.contrast, use_filter = use.filter, use_hue = use.hue, use_saturation = use.saturation,
      exposure = bounded(2.0 ^ s.post_exposure),
      contrast = s.contrast / 100 + 1,
      filter_color = { bounded(c[1]), bounded(c[2]), bounded(c[3]) },
      hue_sextants = whole, hue_part = sextants - whole,
      saturation = s.saturation / 100,
    }
  end,
}
