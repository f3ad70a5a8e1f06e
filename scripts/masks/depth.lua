-- SPDX-License-Identifier: MIT
-- By distance.
local fx = require "afterglow"

return fx.effect {
  name = "depth",
  doc = "What lies between two distances, by the picture's depth.",
  settings = {
    from = fx.float { min = 0, max = 1e10, default = 0, unit = "scene units", doc = "The near end." },
    to = fx.float { min = 0, max = 1e10, default = 10, unit = "scene units", doc = "The far end." },
    softness = fx.float { min = 0, max = 1e6, default = 1, unit = "scene units", doc = "Over which things come and go, outside of the range." },
  },
  needs = { "depth" },
  active = function(s) return s.from <= s.to, "from is above to" end,
  build = function(g, s, source)
    return g:pass { shader = "mask/depth", source = source, depth = g:input("depth"), from = s.from, to = s.to, soft = math.max(s.softness, 1e-6) }
  end,
}
