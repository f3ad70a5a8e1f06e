-- SPDX-License-Identifier: MIT
-- Depth fog: air that takes light from what is far away and gives its own. Beer and Lambert's law along the ray through each pixel; fog that thins with height is integrated
-- in closed form (C. Wenzel, "Real-time Atmospheric Effects in Games", SIGGRAPH 2006; I. Quilez, "Better fog", 2010). Towards a light the fog takes its colour
-- (Quilez). What is seen through fog is also blurred by it, as light is scattered on its way: the farther, the more (the idea is OCASM's SSMS for Unity).
local fx = require "afterglow"
local glow = require "lib.glow"
local pyramids = require "lib.pyramid"

return fx.effect {
  name = "depth_fog",
  doc = "Fog and haze by depth, thinning with height, that scatters light.",
  at = "post_process", order = 5, space = "scene",
  settings = {
    density = fx.float { min = 0, max = 1e6, default = 0.02, unit = "1/m", doc = "How thick the fog is: behind 1/density metres of it 37 % are left. 0: no fog." },
    start = fx.float { min = 0, max = 1e9, default = 2, unit = "m", doc = "Clear air in front of the camera." },
    color = fx.color { default = { 0.2, 0.23, 0.29 }, doc = "Light of the fog itself; scene-linear." },
    ambient = fx.float { min = 0, max = 1, default = 0.5, doc = "How much of the fog's light is that of the picture around, as signs and skies colour the air near them." },
    max_opacity = fx.float { min = 0, max = 1, default = 0.85, doc = "The fog never hides more than this." },
    sky = fx.float { min = 0, max = 1, default = 0.25, doc = "How much of the fog lies before what is infinitely far (1e9 m and more)." },
    scattering = fx.float { min = 0, max = 1, default = 0.5, doc = "How much the fog blurs what is seen through it. 0: not." },
    scattering_radius = fx.float { min = 0.01, max = 1, default = 0.25, doc = "How far it blurs and takes light from, as a share of the picture's height." },
    height_falloff = fx.float { min = 0, max = 100, default = 0, unit = "1/m", doc = "How the fog thins with height: a third each 1/falloff metres. 0: everywhere alike." },
    camera_height = fx.float { min = -1e6, max = 1e6, default = 1.6, unit = "m", doc = "Height of the camera above the level where `density` holds." },
    camera_pitch = fx.float { min = -90, max = 90, default = 0, unit = "degrees", doc = "How far the camera looks up; below 0 down." },
    field_of_view = fx.float { min = 1, max = 170, default = 40, unit = "degrees", doc = "Angle of the picture from top to bottom." },
    sun_color = fx.color { default = { 0, 0, 0 }, doc = "Colour of the fog towards a light; black: the same everywhere." },
    sun = fx.vec2 { min = -10, max = 10, default = { 0.5, 0.4 }, doc = "Where that light stands: {0, 0} is the upper left corner, {1, 1} the lower right; may lie outside." },
    sun_focus = fx.float { min = 0.5, max = 1000, default = 12, doc = "How close to the light the fog has its colour: the power of the angle's cosine." },
    depth_space = fx.enum { "linear", "device", default = "linear",
      doc = "What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z." },
    near = fx.float { min = 1e-6, default = 0.3, unit = "scene units", doc = "Near plane, for device depth." },
    far = fx.float { min = 1e-6, default = 1000, unit = "scene units", doc = "Far plane, for device depth." },
    reversed_z = fx.bool { default = true, doc = "Device depth is 1 at the near plane." },
  },
  needs = { "depth" },
  active = function(s)
    if s.density <= 0 then return false, "density is 0" end
    return s.max_opacity > 0, "max_opacity is 0"
  end,
  -- Exponents of far and low points are large, and their roundings with them.
  holds = { error = { fp32 = 2e-4, fp16 = false, up_to = 1e4, when = function(s)
    return s.depth_space == "linear" and s.height_falloff <= 1 and math.abs(s.camera_height) <= 100 and s.sun_focus <= 100
      and math.max(s.color[1], s.color[2], s.color[3], s.sun_color[1], s.sun_color[2], s.sun_color[3]) <= 1e4
  end } },
  build = function(g, s, source)
    local half = math.tan(math.rad(s.field_of_view) / 2)
    local aspect = source.width / source.height
    local pitch = math.rad(s.camera_pitch)
    local sun_x, sun_y = (2 * s.sun[1] - 1) * half * aspect, (1 - 2 * s.sun[2]) * half
    local length = math.sqrt(sun_x ^ 2 + sun_y ^ 2 + 1)
    local scattered = source
    if s.scattering > 0 or s.ambient > 0 then
      scattered = glow.of(g, source, g.length_scale, glow.fog(source, g.length_scale, 0.5 * s.scattering_radius * source.height), function(width, height) return pyramids.resized(g, source, width, height, "half") end)
    end
    local function held(x) return math.max(-1e30, math.min(x, 1e30)) end
    local view = { half * aspect, half }
    local shares = g:pass {
      shader = "depth_fog/shares", source = source, depth = g:input("depth"), channels = 2, name = "shares",
      device_input = s.depth_space == "device", reversed_z = s.reversed_z, inverse_clip = { 1 / s.near, 1 / s.far },
      -- The fog's density at the camera.
      density = held(s.density * math.exp(math.max(-80, math.min(-s.height_falloff * s.camera_height, 60)))), start = s.start, most = s.max_opacity, sky = s.sky,
      layered = s.height_falloff > 0, falloff = s.height_falloff, up = { math.cos(pitch), math.sin(pitch) }, view = view,
    }
    return g:pass {
      shader = "depth_fog/fog", source = source, shares = shares, scattered = scattered, blur = s.scattering > 0 or s.ambient > 0, name = "final",
      fog = s.color, scattering = s.scattering, ambient = s.ambient, view = view,
      sunny = s.sun_color[1] > 0 or s.sun_color[2] > 0 or s.sun_color[3] > 0, sun_color = s.sun_color, sun = { sun_x / length, sun_y / length, 1 / length }, focus = s.sun_focus,
    }
  end,
}
