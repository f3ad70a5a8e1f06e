-- SPDX-License-Identifier: MIT
-- Motion blur from motion vectors, after M. McGuire, P. Hennessy, M. Bukowski, B. Osman, "A Reconstruction Filter for Plausible Motion Blur"
-- (I3D 2012), J. Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (SIGGRAPH 2014), and J.-P. Guertin, M. McGuire,
-- D. Nowrouzezahrai, "A Fast and Stable Feature-Aware Motion Blur Filter" (HPG 2014): a pixel is blurred along its own way, and what is in front
-- of it and moves otherwise comes along the longest way around, or along the one that leads farthest aside of that. Every pixel of a way is read and
-- counts for the part that the way covers, so that nothing is left to chance: no grain where little moves, no stripes where much does. math.md §16.
-- Motion is in pixels in one frame, x to the right and y up, as renderers write it (Blender's Vector pass, Nuke's forward.u and .v).
local fx = require "afterglow"

return fx.effect {
  name = "motion_blur",
  doc = "Blurs what moves, by motion vectors.",
  at = "post_process", order = 20, space = "scene",
  settings = {
    shutter_angle = fx.float { min = 0, max = 720, default = 180, unit = "degrees", doc = "How long the shutter is open: 360 is the whole frame. 0: no blur." },
    samples = fx.int { min = 3, max = 512, default = 64, doc = "Most reads along a way. A way is read once a pixel; a longer one than this shows stripes, and is cheaper." },
    max_radius = fx.float { min = 1, max = 128, default = 32, unit = "px", doc = "No blur reaches further each way." },
    motion_scale = fx.vec2 { min = -16384, max = 16384, default = { 1, 1 },
      doc = "Factor of the motion vectors: {1, -1} for files with y downwards, {width, height} for motion in pictures." },
    depth_softness = fx.float { min = 1e-4, max = 1e6, default = 0.1, unit = "m", doc = "Difference of depth over which one thing is in front of another. Without depth, what moves farther is in front." },
  },
  needs = { "motion" },
  optional = { "depth" },
  active = function(s) return s.shutter_angle > 0, "shutter_angle is 0" end,
  -- No bound of the error: which of a tile's motions is the longest is decided, where two are as long, by rounding.
  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1 },
  build = function(g, s, source)
    local depth = g:input("depth")
    local shutter = 0.5 * s.shutter_angle / 360
    local radius = math.max(1, s.max_radius)
    local tile = math.ceil(radius)
    local across, down = (source.width + tile - 1) // tile, (source.height + tile - 1) // tile
    local motion = g:pass { shader = "motion_blur/motion", source = source, motion = g:input("motion"), depth = depth or source, has_depth = depth ~= nil,
                            scale = { s.motion_scale[1] * shutter, s.motion_scale[2] * shutter }, max_radius = radius }
    local rows = g:pass { shader = "motion_blur/longest", source = motion, size = { across, source.height }, block = tile, name = "rows" }
    local tiles = g:pass { shader = "motion_blur/longest", source = rows, size = { across, down }, block = tile, down = true, name = "tiles" }
    local neighbours = g:pass { shader = "motion_blur/neighbours", source = tiles, max_radius = radius }
    return g:pass { shader = "motion_blur/gather", source = motion, picture = source, longest = neighbours, tiles = 1 / tile, samples = s.samples,
                    hardness = depth and 1 / s.depth_softness or 1, sparse = 2 * radius > s.samples }
  end,
}
