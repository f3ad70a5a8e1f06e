-- SPDX-License-Identifier: MIT
-- By brightness.
local fx = require "afterglow"

return fx.effect {
  name = "luma",
  doc = "Pixels whose luminance lies between two values.",
  settings = {
    from = fx.float { min = 0, max = 1e6, default = 0.5, doc = "Linear luminance from which pixels count." },
    to = fx.float { min = 0, max = 1e6, default = 1e6, doc = "Up to which they count." },
    softness = fx.float { min = 0, max = 1e6, default = 0.1, doc = "Over which they come and go, outside of the range." },
  },
  active = function(s) return s.from <= s.to, "from is above to", true end,
  build = function(g, s, source)
    return g:pass { shader = "mask/luma", source = source, from = s.from, to = s.to, soft = math.max(s.softness, 1e-6) }
  end,
}
