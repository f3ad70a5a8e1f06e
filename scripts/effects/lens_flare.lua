-- SPDX-License-Identifier: MIT
-- Lens flare: what a lens makes of light that bounces between its glasses. Ghosts are images of bright light mirrored at the middle of the picture, in the shape of the
-- iris and each with the colour of a coating; the halo is the same light thrown onto a ring; the starburst is diffraction at the blades of the iris: as many rays as
-- blades, twice as many where their number is odd. All from the picture itself (J. Chapman, "Pseudo Lens Flare", 2013, and "Screen Space Lens Flare", 2017); the iris is a
-- blur by a polygon instead of sprites, so that every ghost has its shape. Ghosts are made at about 135 lines, rays at 270.
local fx = require "afterglow"
local glow = require "lib.glow"
local rays = require "lib.rays"
local pyramids = require "lib.pyramid"

local function strongest(s) return math.max(s.tint[1], s.tint[2], s.tint[3]) end

return fx.effect {
  name = "lens_flare",
  doc = "Ghosts, a halo and a starburst from the brightest lights.",
  at = "post_process", order = 112, space = "scene",
  settings = {
    ghosts = fx.float { min = 0, max = 100, default = 0.12, doc = "Strength of the ghosts. 0: none." },
    halo = fx.float { min = 0, max = 100, default = 0.05, doc = "Strength of the ring. 0: none." },
    starburst = fx.float { min = 0, max = 100, default = 0.15, doc = "Light of the rays, as a share of the light they come from. 0: none." },
    threshold = fx.float { min = 0, max = 1e6, default = 12, doc = "Brightness (largest channel) from which light flares; linear." },
    clamp = fx.float { min = 0, max = 1e6, default = 150, doc = "No light counts for more than this; linear." },
    count = fx.int { min = 1, max = 8, default = 7, doc = "How many ghosts." },
    spacing = fx.float { min = 0.1, max = 2, default = 1, doc = "How far ghosts lie apart: a factor of their distance from the middle." },
    blades = fx.int { min = 3, max = 12, default = 6, doc = "Blades of the iris: the corners of ghosts." },
    rotation = fx.float { min = -360, max = 360, default = 12, unit = "degrees", doc = "Turns the iris." },
    iris = fx.float { min = 0.005, max = 0.1, default = 0.045, doc = "Radius of the iris's image, as a share of the picture's height." },
    halo_radius = fx.float { min = 0.05, max = 1, default = 0.42, doc = "Radius of the ring, as a share of the picture's height." },
    ray_length = fx.float { min = 0.01, max = 2, default = 0.22, doc = "Where rays have lost 99 % of their light, as a share of the picture's height." },
    dispersion = fx.float { min = 0, max = 1, default = 0.5, doc = "How far colours part in ghosts, ring and rays." },
    tint = fx.color { default = { 1, 1, 1 }, doc = "Colour of it all." },
  },
  active = function(s)
    if s.ghosts <= 0 and s.halo <= 0 and s.starburst <= 0 then return false, "ghosts, halo and starburst are 0" end
    if s.clamp <= s.threshold then return false, "clamp is not above threshold" end
    return strongest(s) > 0, "tint is black"
  end,
  idle = function(s) return { brightest = s.threshold * (1 - 1e-6) } end,
  holds = {
    "black",
    -- Positions between pixels are rounded, and the iris has hard edges.
    error = { fp32 = function(s) return 2e-3 * math.max(1, strongest(s) * (8 * s.ghosts + s.halo + s.starburst)) * math.max(1, s.threshold) end, fp16 = false, up_to = 1e3,
              when = function(s) return strongest(s) * math.max(s.ghosts, s.halo, s.starburst) <= 100 end },
  },
  build = function(g, s, source)
    local width, height = rays.size(g, source, 270)
    local bright = glow.bright(g, source, width, height, s.threshold, s.clamp)
    local sum = nil
    if s.ghosts > 0 or s.halo > 0 then
      local across, down = rays.size(g, source, 135)
      local small = pyramids.resized(g, bright, across, down, "small")
      local radius = math.max(s.iris * down, 0.5)
      local iris = g:pass { shader = "lens_flare/iris", source = small, radius = radius, rings = math.min(math.ceil(radius), 16), blades = s.blades, turn = s.rotation / 360, name = "iris" }
      iris = g:filter { source = iris, size = bright, filter = fx.filters.bspline(), name = "large" }
      sum = g:pass { shader = "lens_flare/ghosts", source = iris, size = bright, count = s.count, ghosts = math.min(s.ghosts, 1e6), halo = math.min(s.halo, 1e6), spacing = s.spacing,
                     ring = s.halo_radius, dispersion = s.dispersion, name = "ghosts" }
    end
    if s.starburst > 0 then
      local count = s.blades % 2 == 0 and s.blades or 2 * s.blades
      local length = s.ray_length * height
      local star = rays.of(g, bright, count, s.rotation + 180 / s.blades, { length * (1 + 0.5 * s.dispersion), length, length * (1 - 0.4 * s.dispersion) })
      local share = math.min(s.starburst, 1e6)
      if sum then sum = g:pass { shader = "glow/add", source = sum, level = star, weight = { share, share, share }, name = "flare" }
      else sum = g:pass { shader = "glow/weigh", source = star, weight = { share, share, share }, name = "flare" } end
    end
    local light = g:filter { source = sum, size = source, filter = fx.filters.bspline(), name = "up" }
    local tint = {}
    for i = 1, 3 do tint[i] = math.min(s.tint[i], 1e6) end
    return g:pass { shader = "glow/tint", source = light, picture = source, tint = tint, name = "final" }
  end,
}
