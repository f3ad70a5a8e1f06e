-- SPDX-License-Identifier: MIT
-- By hue.
local fx = require "afterglow"

return fx.effect {
  name = "hue",
  doc = "Colours of a hue: 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta.",
  settings = {
    center = fx.float { min = -360, max = 360, default = 0, unit = "degrees", doc = "The hue." },
    width = fx.float { min = 0, max = 360, default = 60, unit = "degrees", doc = "How much of the circle counts." },
    softness = fx.float { min = 0, max = 180, default = 20, unit = "degrees", doc = "Over which hues come and go, outside of the width." },
    saturation = fx.float { min = 0, max = 1, default = 0.2, doc = "From which on colours count fully; greys do not." },
  },
  build = function(g, s, source)
    return g:pass { shader = "mask/hue", source = source, center = s.center, half_width = s.width / 2,
                    soft = math.max(s.softness, 1e-4), saturation = math.max(s.saturation, 1e-6) }
  end,
}
