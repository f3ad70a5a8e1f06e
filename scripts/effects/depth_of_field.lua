-- SPDX-License-Identifier: MIT
-- Depth of field: what is not at the focus distance blurs, by the circle of confusion of a thin lens. What lies in front of the focus and what
-- lies behind are blurred apart, in a small picture, and laid over the sharp one at full size: after J. Jimenez, "Next Generation Post Processing
-- in Call of Duty: Advanced Warfare" (SIGGRAPH 2014) and G. Abadie, "A Life of a Bokeh" (SIGGRAPH 2018). Each pixel reads
-- few texels, and its neighbours those between, so that none of them shows. Settings as of Unity's URP (Bokeh) and Blender's cameras. math.md §35.
local fx = require "afterglow"

local kPoints = 8  -- of the autofocus, each way

-- Dioptres of what the autofocus finds, in one texel.
local function found_focus(g, s, source, depth, clip)
  local side = s.focus_area * source.height / kPoints
  local function at(middle) return middle + (0.5 - kPoints / 2) * side end
  local samples = g:pass { shader = "depth_of_field/focus_samples", depth = depth, size = { kPoints, kPoints }, spacing = { side, side },
                           first = { at(s.focus_point[1] * source.width), at(s.focus_point[2] * source.height) },
                           device_input = clip.device_input, reversed_z = clip.reversed_z, inverse_clip = clip.inverse_clip }
  local wanted = g:pass { shader = "depth_of_field/focus_median", values = samples, size = { 1, 1 } }
  -- A start that was off makes no more difference than a hundredth of that after the pre-roll.
  local frames = math.min(math.ceil(math.log(100) / s.focus_speed / g.frame_time), 10000)
  local before = g:history { name = "focus", first = wanted, pre_roll = frames }
  local focused = g:pass { shader = "depth_of_field/focus_follow", source = wanted, before = before, left = math.exp(-s.focus_speed * g.frame_time) }
  g:keep(before, focused)
  return focused
end

return fx.effect {
  name = "depth_of_field",
  doc = "Blurs what is out of focus, by depth, as a camera with this lens does.",
  at = "post_process", order = 10, space = "scene",
  settings = {
    focus_mode = fx.enum { "distance", "point", default = "distance", doc = "distance: focus_distance is sharp. point: an autofocus; what is at focus_point in the picture is sharp, found anew in each frame." },
    focus_distance = fx.float { min = 0.01, max = 1e6, default = 5, unit = "m", doc = "Distance of what is sharp, for focus_mode distance." },
    focus_point = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "Where in the picture the autofocus looks: {0, 0} is the upper left corner, {1, 1} the lower right." },
    focus_area = fx.float { min = 0, max = 1, default = 0.05, doc = "Side of the square around focus_point that the autofocus looks at, in heights of the picture; the median of the distances in it counts." },
    focus_speed = fx.float { min = 0.01, max = 1000, default = 4, unit = "1/s", doc = "How fast the autofocus follows: 4 is nine tenths of the way in 0.6 s. The first frame is focused at once." },
    aperture = fx.float { min = 0.1, max = 64, default = 1.4, unit = "f-number", doc = "The smaller, the more blur." },
    focal_length = fx.float { min = 1, max = 1000, default = 50, unit = "mm", doc = "The longer, the more blur." },
    sensor_height = fx.float { min = 1, max = 200, default = 24, unit = "mm", doc = "Height of the sensor or film: 24 is full frame." },
    max_radius = fx.float { min = 1, max = 64, default = 16, unit = "px", doc = "No blur gets wider than this." },
    samples = fx.int { min = 8, max = 512, default = 64, doc = "About how many reads a pixel of the small picture takes at most; wider circles read coarser pixels instead. More are sharper, and dearer." },
    blades = fx.int { min = 0, max = 12, default = 0, doc = "Sides of the iris, 3 or more; fewer: round." },
    rotation = fx.float { min = -180, max = 180, default = 0, unit = "degrees", doc = "Turns the iris." },
    squeeze = fx.float { min = 0.25, max = 4, default = 1, doc = "Anamorphic lens: 2 makes discs half as wide as high, 0.5 half as high as wide." },
    cat_eye = fx.float { min = 0, max = 1, default = 0, doc = "How much the tube of the lens cuts from discs in the corners of the picture." },
    depth_space = fx.enum { "linear", "device", default = "linear",
      doc = "What the depth input holds: distance along the viewing axis in m, or device depth 0-1, made linear with near, far and reversed_z." },
    near = fx.float { min = 1e-6, default = 0.3, unit = "m", doc = "Near plane, for device depth." },
    far = fx.float { min = 1e-6, default = 1000, unit = "m", doc = "Far plane, for device depth." },
    reversed_z = fx.bool { default = true, doc = "Device depth is 1 at the near plane." },
  },
  needs = { "depth" },

  -- Where a pixel sees nothing but the soft rims of circles, which are wide where the iris is narrow, its light is what little these weigh divided by itself.
  -- Neither linear nor monotone: texels of coarse levels stand where their light lies.
  holds = { "black", "constant", "bounded", continuous = 1,
    error = { fp32 = 5e-4, fp16 = false, up_to = 50, when = function(s) return s.focus_mode == "distance" and s.depth_space == "linear" and s.squeeze >= 0.4 and s.squeeze <= 2.5 end } },
  build = function(g, s, source)
    local f = s.focal_length / 1000
    local d = math.max(s.focus_distance, 1.01 * f)  -- nearer nothing is ever sharp
    -- Radius for what is infinitely far: half the diameter f²/(N(d − f)) on the sensor, in pixels; here for d − f = 1 m.
    local at_metre = 0.5 * f * f / s.aperture / (s.sensor_height / 1000) * source.height
    local radius = math.max(s.max_radius, 1e-3)
    local depth = g:input("depth")
    local clip = { device_input = s.depth_space == "device", reversed_z = s.reversed_z, inverse_clip = { 1 / s.near, 1 / s.far } }
    local is_automatic = s.focus_mode == "point"
    local focused = is_automatic and found_focus(g, s, source, depth, clip) or depth  -- which is not read
    local lens = is_automatic and { f, at_metre, radius } or { d, math.min(at_metre / (d - f), 1e6), radius }
    local function with_circles(pass)
      pass.depth, pass.lens, pass.is_automatic, pass.focused = depth, lens, is_automatic, focused
      for name, value in pairs(clip) do pass[name] = value end
      return g:pass(pass)
    end
    -- In the small picture no circle is wider than 32 pixels. One that is small already stays as it is: discs of few pixels would be squares.
    local is_small = math.max(source.width, source.height) <= 1024 and source.width * source.height <= 1 << 18
    local factor = math.max(is_small and 1 or 2, math.ceil(radius / 32))
    local size = { (source.width + factor - 1) // factor, (source.height + factor - 1) // factor }
    local small = with_circles { shader = "depth_of_field/small", size = size, picture = source, factor = factor, name = "small" }
    -- What is in front is looked for no further than the widest circle of the tiles around.
    local block = math.max(8, math.ceil(radius / factor) + 2)
    local across, down = (size[1] + block - 1) // block, (size[2] + block - 1) // block
    local rows = g:pass { shader = "depth_of_field/widest", source = small, size = { across, size[2] }, block = block, down = false, name = "rows" }
    local tiles = g:pass { shader = "depth_of_field/widest", source = rows, size = { across, down }, block = block, down = true, name = "tiles" }
    local widest = g:pass { shader = "depth_of_field/around", source = tiles }

    local second = g:pass { shader = "depth_of_field/half", source = small, size = { (size[1] + 1) // 2, (size[2] + 1) // 2 }, name = "second" }
    local third = g:pass { shader = "depth_of_field/half", source = second, size = { (second.width + 1) // 2, (second.height + 1) // 2 }, name = "third" }
    local pyramid = g:pass { shader = "depth_of_field/pyramid", source = small, second = second, third = third,
                             size = { size[1] + second.width, math.max(size[2], second.height + third.height) }, name = "pyramid" }
    local middles = g:pass { shader = "depth_of_field/middles", source = pyramid, small = size, size = { second.width, second.height + third.height }, channels = 2, name = "middles" }
    -- The sides of the iris, each by the direction from its middle outwards; 1/cos(π/blades) makes its corners lie on the circle.
    local blades, side = s.blades, 2 * math.pi / math.max(s.blades, 3)
    local first, outwards = s.rotation * math.pi / 180 + side / 2, 1 / math.cos(side / 2)
    local function through_lens(pass)
      pass.source, pass.middles, pass.size, pass.small, pass.blades, pass.has_tube, pass.cat_eye, pass.samples, pass.factor = pyramid, middles, size, size, blades, s.cat_eye > 0, s.cat_eye, s.samples, factor
      pass.turns = { math.cos(first) * outwards, math.sin(first) * outwards, math.cos(side), math.sin(side) }
      pass.stretch = { math.max(1, s.squeeze), math.max(1, 1 / s.squeeze), 2 * math.max(s.squeeze, 1 / s.squeeze) }
      return g:pass(pass)
    end
    local far = through_lens { shader = "depth_of_field/far", name = "far" }
    local disc = blades < 3 and 1 or math.sin(side) / side
    local near = through_lens { shader = "depth_of_field/near", widest = widest, tiles = 1 / block, part = disc / math.max(s.squeeze, 1 / s.squeeze), name = "near" }
    far = g:pass { shader = "depth_of_field/fill", source = far, name = "far_filled" }
    near = g:pass { shader = "depth_of_field/fill", source = near, name = "near_filled" }
    return with_circles { shader = "depth_of_field/final", size = source, picture = source, far = far, near = near, factor = factor, name = "final" }
  end,
}
