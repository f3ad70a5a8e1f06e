-- SPDX-License-Identifier: MIT
-- Glare: what a lens or an eye adds to bright light, as Blender's Glare node does it. star: rays from each light, as many as the iris has points; streaks: long rays both ways along one
-- line; fog_glow: a haze that falls with the square of the distance, as a dirty filter or a wet eye has it. Rays are Kawase's (lib/rays.lua); red goes further than blue,
-- as it is diffracted more.
local fx = require "afterglow"
local glow = require "lib.glow"
local rays = require "lib.rays"

local function strongest(s) return s.intensity * math.max(s.tint[1], s.tint[2], s.tint[3]) end

return fx.effect {
  name = "glare",
  doc = "Stars, streaks or a foggy glow around bright lights.",
  at = "post_process", order = 108, space = "scene",
  settings = {
    kind = fx.enum { "star", "streaks", "fog_glow", default = "star", doc = "star: rays around each light. streaks: rays along one line. fog_glow: a haze." },
    intensity = fx.float { min = 0, max = 100, default = 0.18, doc = "Light of the glare, as a share of the light that glares; all rays of a light share it. 0: none." },
    threshold = fx.float { min = 0, max = 1e6, default = 8, doc = "Brightness (largest channel) from which light glares; linear." },
    clamp = fx.float { min = 0, max = 1e6, default = 200, doc = "No light counts for more than this; linear." },
    points = fx.int { min = 2, max = 16, default = 6, doc = "star: rays around a light." },
    angle = fx.float { min = -360, max = 360, default = 15, unit = "degrees", doc = "star, streaks: direction of the first ray; 0 is to the right, 90 up." },
    size = fx.float { min = 0.005, max = 2, default = 0.25, doc = "How far light goes, as a share of the picture's height: where a ray has lost 99 %; the extent of the haze, which grows up to about 0.5." },
    dispersion = fx.float { min = 0, max = 1, default = 0.4, doc = "star, streaks: how much longer red rays are than blue ones. 0: rays have the light's own colour." },
    tint = fx.color { default = { 1, 1, 1 }, doc = "Colour of the glare." },
  },
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    if s.clamp <= s.threshold then return false, "clamp is not above threshold" end
    return s.tint[1] > 0 or s.tint[2] > 0 or s.tint[3] > 0, "tint is black"
  end,
  idle = function(s) return { brightest = s.threshold * (1 - 1e-6) } end,
  holds = {
    "black",
    continuous = function(s) return 1 + 1.1 * strongest(s) end,
    constant = { when = function(s) return s.kind == "fog_glow" end },
    -- Positions between pixels are rounded.
    error = { fp32 = function(s) return (s.kind == "fog_glow" and 2e-5 or 1e-3) * math.max(1, strongest(s)) * math.max(1, s.threshold) end,
              fp16 = function(s) return 4e-3 * math.max(1, strongest(s)) * math.max(1, s.threshold) end, up_to = 1e3,
              when = function(s) return strongest(s) <= 100 end },
  },
  build = function(g, s, source)
    local light
    if s.kind == "fog_glow" then
      light = glow.of(g, source, g.length_scale, glow.fog(source, g.length_scale, 0.5 * s.size * source.height), function(width, height) return glow.bright(g, source, width, height, s.threshold, s.clamp) end)
    else
      local width, height = rays.size(g, source, 540)
      local image = glow.bright(g, source, width, height, s.threshold, s.clamp)
      local length = s.size * height
      local star = s.kind == "star"
      light = rays.of(g, image, star and s.points or 2, s.angle, { length * (1 + 0.5 * s.dispersion), length, length * (1 - 0.4 * s.dispersion) })
      light = g:filter { source = light, size = source, filter = fx.filters.bspline(), name = "up" }
    end
    local tint = {}
    for i = 1, 3 do tint[i] = math.min(s.tint[i] * s.intensity, 1e6) end
    return g:pass { shader = "glow/tint", source = light, picture = source, tint = tint, name = "final" }
  end,
}
