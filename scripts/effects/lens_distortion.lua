-- SPDX-License-Identifier: MIT
-- Lens distortion: barrel and pincushion. Unity's model (URP, UberPost: DistortUV): a point at distance r of the centre is read at
-- tan(θr)/σ for a barrel and atan(σr)/θ for a pincushion, θ = min(1.6·100·|intensity|, 160) degrees, σ = 2 tan(θ/2).
local fx = require "afterglow"

local function fills(s) return s.edges ~= "black" end

-- A place is rounded as the picture is large, and as far away as what is enlarged into it.
local function place_digits(s, source) return 2e-5 * math.max(source.width, source.height) * math.max(1, 0.2 / s.scale) end

local function angle(s) return math.rad(math.min(1.6 * math.max(math.abs(s.intensity) * 100, 1), 160)) end

-- A barrel's tangent has no bound where rays come from beyond a right angle, as they do far from a centre that is moved aside.
local function sees_ahead(s)
  local x, y = math.max(s.center[1], 1 - s.center[1]) * s.x_multiplier, math.max(s.center[2], 1 - s.center[2]) * s.y_multiplier
  return s.intensity < 0 or math.sqrt(x * x + y * y) / s.scale * angle(s) < 1.4
end

return fx.effect {
  name = "lens_distortion",
  doc = "Bends the picture as a wide lens (barrel) or a long one (pincushion) does.",
  at = "post_process", order = 130, detail = true,
  settings = {
    intensity = fx.float { min = -1, max = 1, default = 0.2, doc = "Above 0 a barrel, below 0 a pincushion. 0: none, but for the scale." },
    x_multiplier = fx.float { min = 0, max = 1, default = 1, doc = "How much of it happens across." },
    y_multiplier = fx.float { min = 0, max = 1, default = 1, doc = "How much of it happens down." },
    center = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "The point that stays: {0, 0} is the upper left corner, {1, 1} the lower right." },
    scale = fx.float { min = 0.01, max = 5, default = 1, doc = "Enlarges the result around the centre, to hide edges that were drawn in." },
    edges = fx.enum { "stretch", "mirror", "black", default = "stretch", doc = "What stands where the picture ends: its last pixels, its mirror image, or black." },
  },
  active = function(s)
    local bends = s.intensity ~= 0 and (s.x_multiplier > 0 or s.y_multiplier > 0)
    return bends or s.scale ~= 1, "nothing bends and scale is 1"
  end,
  -- Positions between pixels are rounded: the more, the larger the picture; so what is read at a hard edge is off by as much, and what is
  -- mirrored from far outside is anywhere.
  holds = { "black", constant = { when = fills }, bounded = { when = fills }, "monotone", "linear", continuous = 1,
            error = { fp32 = function(s, source) return 1e-3 + place_digits(s, source) end, fp16 = function(s, source) return 4e-3 + place_digits(s, source) end, up_to = 1, when = function(s) return s.edges ~= "mirror" and sees_ahead(s) end } },
  build = function(g, s, source)
    local theta = angle(s)
    return g:pass {
      shader = "lens_distortion/bend", source = source, barrel = s.intensity >= 0, mirrored = s.edges == "mirror", black = s.edges == "black",
      theta = theta, sigma = 2 * math.tan(theta / 2), bend = s.intensity ~= 0 and 1 or 0,
      center = { s.center[1] - 0.5, s.center[2] - 0.5 },
      axes = { math.max(s.x_multiplier, 1e-4), math.max(s.y_multiplier, 1e-4) }, inverse_scale = 1 / s.scale,
    }
  end,
}
