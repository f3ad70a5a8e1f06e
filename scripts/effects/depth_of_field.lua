-- SPDX-License-Identifier: MIT
-- Depth of field: what is not at the focus distance blurs, by the circle of confusion of a thin lens. One gather on a golden spiral, after
-- D. Gustafsson, "Bokeh depth of field in a single pass" (2018): a read counts where its own circle reaches the pixel, and what lies behind
-- the pixel may not be blurrier than twice the pixel itself. So sharp things neither spread nor are spread over, and blurred things in front
-- have soft edges. Settings as of Unity's URP (Bokeh).
local fx = require "afterglow"

return fx.effect {
  name = "depth_of_field",
  doc = "Blurs what is out of focus, by depth, as a camera with this lens does.",
  at = "post_process", order = 10, space = "scene",
  settings = {
    focus_distance = fx.float { min = 0.01, max = 1e6, default = 10, unit = "m", doc = "Distance of what is sharp." },
    aperture = fx.float { min = 0.1, max = 64, default = 5.6, unit = "f-number", doc = "The smaller, the more blur." },
    focal_length = fx.float { min = 1, max = 1000, default = 50, unit = "mm", doc = "The longer, the more blur." },
    sensor_height = fx.float { min = 1, max = 200, default = 24, unit = "mm", doc = "Height of the sensor or film: 24 is full frame." },
    max_radius = fx.float { min = 1, max = 64, default = 16, unit = "px", doc = "No blur gets wider than this." },
    samples = fx.int { min = 8, max = 512, default = 96, doc = "Reads for each pixel: more are smoother, and dearer." },
    depth_space = fx.enum { "linear", "device", default = "linear",
      doc = "What the depth input holds: distance along the viewing axis in m, or device depth 0-1, made linear with near, far and reversed_z." },
    near = fx.float { min = 1e-6, default = 0.3, unit = "m", doc = "Near plane, for device depth." },
    far = fx.float { min = 1e-6, default = 1000, unit = "m", doc = "Far plane, for device depth." },
    reversed_z = fx.bool { default = true, doc = "Device depth is 1 at the near plane." },
  },
  needs = { "depth" },

  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1, 
    error = { fp32 = 5e-4, fp16 = false, up_to = 50, when = function(s) return s.depth_space == "linear" end } },
  build = function(g, s, source)
    local f = s.focal_length / 1000
    local d = math.max(s.focus_distance, 1.01 * f)  -- nearer nothing is ever sharp
    -- Radius for what is infinitely far: half the diameter f²/(N(d − f)) on the sensor, in pixels.
    local infinity = 0.5 * f * f / (s.aperture * (d - f)) / (s.sensor_height / 1000) * source.height
    local image = g:pass { shader = "depth_of_field/circle", source = source, depth = g:input("depth"), focus_distance = d,
                           infinity = math.min(infinity, 1e6), max_radius = s.max_radius, device_input = s.depth_space == "device",
                           reversed_z = s.reversed_z, inverse_clip = { 1 / s.near, 1 / s.far }, name = "circle" }
    -- Reads go no further than the widest circle of the tiles around: where little is blurred, they lie close.
    local tile = math.ceil(s.max_radius)
    local across, down = (source.width + tile - 1) // tile, (source.height + tile - 1) // tile
    local rows = g:pass { shader = "depth_of_field/widest", source = image, size = { across, source.height }, block = tile, down = false, name = "rows" }
    local tiles = g:pass { shader = "depth_of_field/widest", source = rows, size = { across, down }, block = tile, down = true, name = "tiles" }
    return g:pass { shader = "depth_of_field/gather", source = image, picture = source, widest = g:pass { shader = "depth_of_field/around", source = tiles },
                    block = tile, max_radius = s.max_radius, samples = s.samples }
  end,
}
