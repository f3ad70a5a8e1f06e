-- SPDX-License-Identifier: MIT
-- OpenColorIO display: the view of a studio's configuration, in place of a tone curve. The shader is OpenColorIO's own, so that every view that
-- it can show is done, and the same to 1e-4 as its CPU processor shows it. The configuration is a file beside the preset or on the search path, else
-- the one that the variable OCIO of the environment names.
-- The picture comes in linear Rec.709, which a configuration has under one of its usual names ("Linear Rec.709 (sRGB)", "lin_rec709", …) or by way
-- of its role aces_interchange; `from` names another space for pictures that are not. What comes out are the display's codes; they are brought to light by
-- the sRGB curve, which the output encodes them with again (`view = true`): integers in files and videos are exactly the view's codes, whatever
-- display it is for, and are not said to be sRGB.
local fx = require "afterglow"
local working_space = require "lib.working_space"

return fx.effect {
  name = "ocio_display",
  doc = "The view of an OpenColorIO configuration, in place of a tone curve.",
  at = "post_process", order = 200, alpha = "straight",
  space = function(s) return { needs = working_space[s.from] and "scene" or "other", makes = "display", view = true } end,
  settings = {
    config = fx.file { extensions = { "ocio" }, doc = "The configuration: beside the preset or on the search path. None: the one that $OCIO names." },
    display = fx.text { doc = "Display. None: the configuration's default." },
    view = fx.text { doc = "View of the display. None: the display's default." },
    looks = fx.text { doc = "Looks in place of the view's own, like \"+warm, -night\". None: those of the view." },
    from = fx.text { doc = "Colour space of the picture. None: linear Rec.709." },
  },
  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1 },
  build = function(g, s, source)
    local view = g:ocio { config = s.config, display = s.display, view = s.view, looks = s.looks, from = s.from }
    local codes = g:pass { shader = view.shader, source = source, table = view.table, name = "view" }
    return g:pass { shader = "ocio/from_codes", source = codes }
  end,
}
