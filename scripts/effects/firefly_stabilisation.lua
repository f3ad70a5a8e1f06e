-- SPDX-License-Identifier: MIT
-- Firefly stabilisation: takes single bright pixels that flash up for a frame down to what stands around them or was there before. A pixel keeps its
-- light when its surroundings are about as bright (two pixels of the ring at distance 2: edges, lines, highlights of some size) or when each of the
-- last frames had such light within `search` pixels (small lights, also moving ones). Colours are only scaled down, never mixed with other frames,
-- so nothing smears; a small light that is new reaches its full brightness after `frames` frames.
local fx = require "afterglow"

return fx.effect {
  name = "firefly_stabilisation",
  doc = "Takes down single bright pixels that flash up in one frame of a sequence.",
  at = "before_post_process", order = -100,
  settings = {
    threshold = fx.float { min = 0, max = 1e6, default = 1, doc = "Brightness (largest channel) up to which a pixel is left alone; linear." },
    tolerance = fx.float { min = 1, max = 1000, default = 2, doc = "How many times as bright as its surroundings or its past a pixel may be." },
    search = fx.int { min = 0, max = 8, default = 3, unit = "px", doc = "How far a small light may move from frame to frame and still be known." },
    frames = fx.int { min = 1, max = 4, default = 2, doc = "How many earlier frames must have had the light: more take down fireflies that come twice." },
    first_frame = fx.enum { "keep", "clamp", default = "keep",
      doc = "Where there are no earlier frames. keep: everything stays. clamp: single bright pixels go, small lights too." },
  },
  idle = function(s) return { brightest = s.threshold } end,
  holds = { "black", "constant", "mirror", "turn_180", no_added_light = 1e-6 },
  build = function(g, s, source)
    -- The brightness of as many last frames in a channel each, 65504 and above as without limit: what was before the first one counts as bright or as
    -- dark. What is kept is handed on and never added to: half floats are enough.
    local unknown, channels = s.first_frame == "keep" and 65504 or 0, s.frames == 3 and 4 or s.frames
    local before = g:history { name = "before", size = source, first = { unknown, unknown, unknown, unknown }, pre_roll = s.frames,
                               channels = channels, precise = false }
    g:keep(before, g:pass { shader = "firefly_stabilisation/remember", source = source, before = before, channels = channels })
    return g:pass { shader = "firefly_stabilisation/clamp", source = source, before = before, threshold = s.threshold,
                    tolerance = s.tolerance, search = s.search, frames = s.frames, reach = math.max(s.search * s.frames, 2) }
  end,
}
