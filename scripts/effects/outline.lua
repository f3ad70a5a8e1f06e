-- SPDX-License-Identifier: MIT
-- Outlines where depth or normals change from pixel to pixel.
-- After "HDRP full-screen outlines" (custom pass, offset and ddx/ddy variants), with its rounding, border and scale errors mended:
-- neighbours are whole pixels, reads are clamped to the picture, every factor is a setting.
local fx = require "afterglow"

local function uses(s)
  return {
    depth = s.source ~= "normals",
    normal = s.source == "normals" or s.source == "mixed",
    -- The width fades with distance whenever there is depth; quads of the derivative have no width.
    fade = s.difference == "offset",
  }
end

-- Only the size of a factor counts, and it must stay one in 32-bit floats.
local function bounded(x) return math.min(math.abs(x), 1e30) end

return fx.effect {
  name = "outline",
  doc = "Ink lines along edges of depth, of normals, or of both.",
  at = "before_post_process", order = 0, detail = true,
  settings = {
    source = fx.enum { "depth", "device_depth", "normals", "mixed", default = "mixed",
      doc = "What is compared: distance, stored device depth as it is, normals, or distance and normals." },
    difference = fx.enum { "offset", "derivative", default = "offset",
      doc = "offset: with the pixels `width` to the right and below. derivative: within 2x2 quads, as GPU derivatives do; lines are dashed." },
    depth_space = fx.enum { "linear", "device", default = "linear",
      doc = "What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z." },
    near = fx.float { min = 1e-6, default = 0.3, unit = "scene units", doc = "Near plane, for device depth." },
    far = fx.float { min = 1e-6, default = 1000, unit = "scene units", doc = "Far plane, for device depth." },
    reversed_z = fx.bool { default = true, doc = "Device depth is 1 at the near plane." },
    combine = fx.enum { "weighted", "max", default = "weighted", doc = "mixed: weighted sum of both edges, or the stronger one." },
    normal_factor = fx.float { min = 0, max = 1, default = 0.5, doc = "mixed, weighted: share of normals; the rest is depth." },
    width = fx.float { min = 0, default = 1, unit = "px", doc = "offset: distance of the compared pixels; rounded to whole pixels after fading." },
    fade_distance = fx.float { min = 1e-6, default = 1000, unit = "scene units",
      doc = "offset: where the width has shrunk to 0. Without a depth input lines don't fade." },
    depth_scale = fx.float { default = 1, doc = "Factor of depth differences: edges per scene unit." },
    normal_scale = fx.float { default = 1, doc = "Factor of normal differences; a right angle differs by 1.41." },
    divide_factor = fx.float { min = 1e-6, default = 1, doc = "The edge is divided by this." },
    contrast = fx.float { min = 0, default = 1, doc = "Steepness around an edge of one half: 1 leaves it, high values make lines hard and drop weak ones." },
    smoothness = fx.float { min = 0, max = 1, default = 0, doc = "How much 3x3 pixels decide together: lines get smooth sides and no teeth, and crawl less in sequences. 0: each pixel for itself." },
    level_slopes = fx.bool { default = true,
      doc = "offset: depth counts as far as it leaves the plane that goes on from the pixel behind, so that ground seen at a grazing angle draws no line. false: every difference counts, as in the source." },
    color = fx.color { default = { 0, 0, 0 }, doc = "Ink. It ends where the picture's alpha is 0." },
    blend = fx.enum { "lerp", "add", default = "lerp", doc = "lerp: ink covers the picture. add: ink is light that is added." },
  },

  needs = function(s)
    local use, names = uses(s), {}
    if use.depth then names[#names + 1] = "depth" end
    if use.normal then names[#names + 1] = "normal" end
    return names
  end,
  optional = function(s) return uses(s).fade and { "depth" } or {} end,

  active = function(s, length_scale)
    if s.difference == "offset" and s.width < 0.5 * math.min(length_scale, 1) and s.contrast >= 1 then return false, "width rounds to 0 pixels" end
    if s.blend == "add" and s.color[1] == 0 and s.color[2] == 0 and s.color[3] == 0 then return false, "adds black" end
    return true
  end,

  -- An edge is `contrast` times as steep, its smoothing 4 times more; what is bright shines through ink that is not quite opaque.
  holds = {
    error = { fp32 = function(s) return 1e-4 * math.max(1, s.contrast) * (1 + 3 * s.smoothness) end, fp16 = false, when = function(s)  -- of the line, not of its share of a colour without limit
      return math.max(s.color[1], s.color[2], s.color[3]) <= 1e4 and s.depth_space == "linear" and s.contrast <= 100 and math.abs(s.depth_scale) <= 100 and math.abs(s.normal_scale) <= 100 and s.divide_factor >= 1e-3
    end },
  },
  build = function(g, s, source)
    if s.source == "device_depth" and s.depth_space ~= "device" then
      error('source = "device_depth" requires depth_space = "device"', 0)
    end
    local use = uses(s)
    -- Pixels across which the widest line is drawn, with room for what floats round: where no line is wider than one, all pixels are
    -- compared with their neighbours, and rows of them share what they read.
    local width = math.min(s.width / g.length_scale, 16384)
    local widest = math.floor(width * 1.000001 + 0.5) * g.length_scale
    local depth = (use.depth or use.fade) and g:input("depth") or nil
    local normal = use.normal and g:input("normal") or nil
    local lines = g:pass {
      shader = "outline/lines", size = source, name = "lines",
      depth = depth or source, normal = normal or source,  -- what is missing is not read
      use_depth = use.depth, use_normal = use.normal,
      reach = s.difference == "derivative" and 1 or math.min(2 * (s.width + math.max(1, g.length_scale)), 16384),
      derivative = s.difference == "derivative", fade = use.fade and depth ~= nil,
      device_input = s.depth_space == "device", reversed_z = s.reversed_z, raw_depth = s.source == "device_depth",
      next_door = s.difference == "offset" and widest < 1.4999, combine_max = s.combine == "max", level_slopes = s.level_slopes and s.difference == "offset", preview = g.length_scale < 1,
      inverse_clip = { 1 / s.near, 1 / s.far },
      width = width, scale = g.length_scale, fade_distance = s.fade_distance,
      depth_scale = bounded(s.depth_scale), normal_scale = bounded(s.normal_scale), normal_factor = s.normal_factor,
      divide_factor = s.divide_factor, contrast = bounded(s.contrast),
    }
    if s.smoothness > 0 then lines = g:pass { shader = "outline/smooth", source = lines, share = s.smoothness, reach = 1, name = "smooth" } end
    return g:pass { shader = "outline/ink", source = lines, picture = source, ink = s.color, add_light = s.blend == "add", name = "ink" }
  end,
}
