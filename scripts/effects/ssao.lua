-- SPDX-License-Identifier: MIT
-- SSAO: where surfaces stand close together, less light of the surroundings reaches them. Scalable Ambient Obscurance (M. McGuire, M. Mara, D. Luebke, HPG 2012) with its
-- falloff: reads on a spiral around each pixel, each of which counts by how far it rises above the pixel's surface within the radius. Made at half the size with a
-- pattern of 4×4 pixels, smoothed along surfaces, and enlarged along them. Light that shines by itself is spared.
local fx = require "afterglow"

local function cross(a, b) return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] } end
local function unit(v, else_)
  local length = math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
  if length < 1e-12 then return else_ end
  return { v[1] / length, v[2] / length, v[3] / length }
end

return fx.effect {
  name = "ssao",
  doc = "Soft contact shadows in corners and under things, by depth.",
  at = "before_post_process", order = -50, space = "scene",
  settings = {
    intensity = fx.float { min = 0, max = 8, default = 1, doc = "How dark occluded places get. 0: no effect." },
    radius = fx.float { min = 1e-3, max = 1e4, default = 0.6, unit = "m", doc = "Nothing farther away than this occludes." },
    max_radius = fx.float { min = 0.01, max = 1, default = 0.2, doc = "The radius in the picture, as a share of its height, is held to this for what is near." },
    samples = fx.int { min = 4, max = 64, default = 16, doc = "Reads for each pixel." },
    bias = fx.float { min = 0, max = 1, default = 0.03, doc = "How far something must rise above a surface to occlude, as a share of the radius: keeps flat things clean." },
    spare = fx.float { min = 0, max = 1e6, default = 1.5, doc = "Brightness (largest channel) from which light is spared, fully at four times as much; linear. Lamps have no shadows." },
    color = fx.color { default = { 0, 0, 0 }, doc = "What occluded places are multiplied by." },
    field_of_view = fx.float { min = 1, max = 170, default = 40, unit = "degrees", doc = "Angle of the picture from top to bottom." },
    normals = fx.enum { "from_depth", "view", "world", default = "from_depth",
      doc = "from_depth: surfaces are found from depth alone. view, world: from the normals of the picture, in the camera's space (x right, y up, z towards it) or the world's." },
    camera_forward = fx.vec3 { min = -1, max = 1, default = { 0, 1, 0 }, doc = "world: where the camera looks." },
    camera_up = fx.vec3 { min = -1, max = 1, default = { 0, 0, 1 }, doc = "world: what is up for the camera." },
    depth_space = fx.enum { "linear", "device", default = "linear",
      doc = "What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z." },
    near = fx.float { min = 1e-6, default = 0.3, unit = "scene units", doc = "Near plane, for device depth." },
    far = fx.float { min = 1e-6, default = 1000, unit = "scene units", doc = "Far plane, for device depth." },
    reversed_z = fx.bool { default = true, doc = "Device depth is 1 at the near plane." },
  },
  needs = function(s) return s.normals == "from_depth" and { "depth" } or { "depth", "normal" } end,
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    return s.color[1] ~= 1 or s.color[2] ~= 1 or s.color[3] ~= 1, "color is white"
  end,
  -- No bound on the error: which side of an edge a surface belongs to is decided by comparing.
  holds = { "black", monotone = { when = function(s) return s.spare >= 1e6 and s.color[1] <= 1 and s.color[2] <= 1 and s.color[3] <= 1 end } },
  build = function(g, s, source)
    local tan = math.tan(math.rad(s.field_of_view) / 2)
    local depth = g:input("depth")
    local forward = unit(s.camera_forward, { 0, 1, 0 })
    local right = unit(cross(forward, s.camera_up), { 1, 0, 0 })
    local up = cross(right, forward)
    local size = { (source.width + 1) // 2, (source.height + 1) // 2 }
    local view = { tan * source.width / source.height, tan }
    local surface = g:pass {
      shader = "ssao/surface", depth = depth, normal = s.normals ~= "from_depth" and g:input("normal") or depth, size = size, name = "surface",
      source_normals = ({ from_depth = 0, view = 1, world = 2 })[s.normals], device_input = s.depth_space == "device", reversed_z = s.reversed_z,
      inverse_clip = { 1 / s.near, 1 / s.far }, view = view, right = right, up = up, forward = forward,
    }
    local image = g:pass { shader = "ssao/occlusion", source = surface, size = size, name = "occlusion", samples = s.samples, radius = s.radius, bias = s.bias, view = view,
                           most = s.max_radius * size[2], strength = s.intensity, channels = 2 }
    image = g:pass { shader = "ssao/smooth", source = image, size = size, along = { 1, 0 }, reach = 3, channels = 2, name = "across" }
    image = g:pass { shader = "ssao/smooth", source = image, size = size, along = { 0, 1 }, reach = 3, channels = 2, name = "down" }
    return g:pass { shader = "ssao/shade", source = source, occlusion = image, depth = depth, size = source, name = "shade", shadow = s.color, spare = s.spare,
                    device_input = s.depth_space == "device", reversed_z = s.reversed_z, inverse_clip = { 1 / s.near, 1 / s.far } }
  end,
}
