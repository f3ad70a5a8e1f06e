-- SPDX-License-Identifier: MIT
-- OpenColorIO transform: from one colour space of a configuration to another, through looks where they are given; by OpenColorIO's own shader, the same to
-- 1e-4 as its CPU processor. A space that is not given is linear Rec.709, the space that looks work in (how a configuration is asked for it: see
-- ocio_display). Values go out as the space has them: whoever goes to a logarithm has to come back before the tone curve.
local fx = require "afterglow"
local working_space = require "lib.working_space"

return fx.effect {
  name = "ocio_transform",
  doc = "Colours from one space of an OpenColorIO configuration to another, with looks.",
  at = "post_process", order = 150, alpha = "straight",
  space = function(s)
    local needs, makes = working_space[s.from] and "scene" or "other", working_space[s.to] and "scene" or "other"
    if s.inverse then needs, makes = makes, needs end
    return { needs = needs, makes = makes }
  end,
  settings = {
    config = fx.file { extensions = { "ocio" }, doc = "The configuration: beside the preset or on the search path. None: the one that $OCIO names." },
    from = fx.text { doc = "Colour space that the colours are in. None: linear Rec.709." },
    to = fx.text { doc = "Colour space that they are brought to. None: linear Rec.709." },
    looks = fx.text { doc = "Looks on the way, like \"+warm, -night\"." },
    inverse = fx.bool { default = false, doc = "The other way round." },
  },
  active = function(s)
    local none = s.from == ""
    return s.from ~= s.to or s.looks ~= "", none and "neither spaces nor looks are given" or "from and to are the same", none
  end,
  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1 },
  build = function(g, s, source)
    local change = g:ocio { config = s.config, from = s.from, to = s.to, looks = s.looks, inverse = s.inverse }
    return g:pass { shader = change.shader, source = source, table = change.table, name = "change" }
  end,
}
