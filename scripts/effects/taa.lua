-- SPDX-License-Identifier: MIT
-- TAA: each frame is joined with what the frames before it showed at the same places, found by motion vectors. What was there is held to the colours around the pixel now, so that
-- nothing stays behind what moves: B. Karis, "High Quality Temporal Supersampling" (SIGGRAPH 2014); the bounds are mean and deviation (M. Salvi, "An excursion in
-- temporal supersampling", GDC 2016); the past is read by Catmull and Rom's spline, so that it stays sharp. For noise and shimmer of renders that are not jittered, too.
local fx = require "afterglow"

-- Frames until less than a 512th of a difference at the start is left.
local function pre_roll(s) return math.ceil(math.log(1 / 512) / math.log(s.feedback)) end

return fx.effect {
  name = "taa",
  doc = "Temporal anti-aliasing: steadies noise and shimmering edges over frames, by motion vectors.",
  at = "before_post_process", order = -80, space = "scene",
  settings = {
    feedback = fx.float { min = 0, max = 0.98, default = 0.88, doc = "How much of the past is kept in each frame: 0.9 averages about ten frames. 0: no effect." },
    bounds = fx.float { min = 0, max = 10, default = 1.25, doc = "How far the past may lie from the colours around, in standard deviations: more is steadier, and leaves trails." },
    direction = fx.enum { "to_previous", "to_next", default = "to_previous",
      doc = "Where motion vectors point: to the place in the frame before (Blender, most engines), or to that in the next one (Nuke's forward)." },
    motion_scale = fx.vec2 { min = -16384, max = 16384, default = { 1, 1 },
      doc = "Factor of the motion vectors: {1, -1} for files with y downwards, {width, height} for motion in pictures." },
  },
  needs = { "motion" },
  optional = { "depth" },
  active = function(s) return s.feedback > 0, "feedback is 0" end,
  -- A first frame has no past and stays.
  holds = { "black", "constant", "bounded" },
  build = function(g, s, source)
    local depth = g:input("depth")
    local sign = s.direction == "to_previous" and 1 or -1
    local before = g:history { name = "before", size = source, first = { 0, 0, 0, 0 }, pre_roll = pre_roll(s) }
    local joined = g:pass { shader = "taa/join", source = source, before = before, motion = g:input("motion"), depth = depth or source, has_depth = depth ~= nil,
                            scale = { s.motion_scale[1] * sign, s.motion_scale[2] * sign }, feedback = s.feedback, bounds = s.bounds, name = "join" }
    g:keep(before, joined)
    return g:pass { shader = "taa/show", source = joined, picture = source, name = "show" }
  end,
}
