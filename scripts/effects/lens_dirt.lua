-- SPDX-License-Identifier: MIT
-- Lens dirt: dust and smudges on the front glass, seen where bright light falls through them. The light is a wide blur of what exceeds a
-- threshold; the dirt is made of smudges and of grains at random places, or is a picture of yours. Made dirt is out of focus, and the light behind
-- it wide: both are made at a quarter of the size.
local fx = require "afterglow"
local glow = require "lib.glow"
local placed = require "lib.placed"
local pyramids = require "lib.pyramid"

return fx.effect {
  name = "lens_dirt",
  doc = "Dust on the lens that lights up around bright lights.",
  at = "post_process", order = 120, space = "scene",
  settings = {
    intensity = fx.float { min = 0, max = 100, default = 1, doc = "Factor of the light that the dirt scatters. 0: none." },
    threshold = fx.float { min = 0, max = 1e6, default = 1, doc = "Brightness (largest channel) from which light shows the dirt; linear." },
    density = fx.float { min = 0, max = 1, default = 0.4, doc = "How much dirt there is. 0: none." },
    size = fx.float { min = 0.005, max = 0.5, default = 0.06, doc = "Diameter of the largest spots, as a share of the picture's height." },
    seed = fx.int { min = 0, default = 0, doc = "Another number, another lens." },
    texture = fx.file { extensions = { "png", "exr", "tif", "tiff", "hdr", "jpg", "jpeg", "webp" }, doc = "A picture of the dirt, white on black, in place of what density, size and seed make; so large that it covers the picture." },
  },
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    return s.density > 0 or s.texture ~= "", "density is 0"
  end,
  holds = { "black", "monotone", continuous = function(s) return 1 + s.intensity end,
    -- Where a spot begins, its opacity is a small difference of distances (3e-6 of it are rounding), and the light may be strong.
    error = { fp32 = function(s) return 5e-5 * math.max(1, s.intensity) end, fp16 = 5e-3, up_to = 50 } },
  build = function(g, s, source)
    local width, height = pyramids.delivered(g, source)
    local sizes = { { math.max(width // 2, 1), math.max(height // 2, 1) } }
    while math.min(sizes[#sizes][1], sizes[#sizes][2]) >= 16 do
      sizes[#sizes + 1] = { sizes[#sizes][1] // 2, sizes[#sizes][2] // 2 }
    end
    local start = g.length_scale < 1 and pyramids.start(sizes, source.width, source.height) or 1
    local image = glow.bright(g, source, sizes[start][1], sizes[start][2], s.threshold)
    for i = start + 1, #sizes do
      image = g:filter { source = image, size = sizes[i], filter = fx.filters.tent(), name = ("down[%d]"):format(i - 1) }
    end
    if s.texture ~= "" then
      local room = { source.width, source.height }
      local size, dirt = placed.sized(g, g:image { file = s.texture }, room, "cover", 1)
      local light = g:filter { source = image, size = source, filter = fx.filters.bspline(), name = "light" }
      return g:pass { shader = "lens_dirt/through", source = light, high = source, dirt = dirt, intensity = s.intensity,
                      corner = placed.corner(room, size, { 0.5, 0.5 }, 0), extent = size, name = "final" }
    end
    -- A preview's dirt is made in pixels as large as the delivered picture's are in its own.
    local factor = math.max(1, math.floor(4 * g.length_scale + 0.5))
    local small = { (source.width + factor - 1) // factor, (source.height + factor - 1) // factor }
    local cell = math.max(s.size * source.height / factor, 1)
    local coarse = math.floor(cell * 64) / 64
    local dirt = g:pass { shader = "lens_dirt/spots", size = small, cell = { coarse, cell - coarse }, density = s.density,
                          seed = s.seed, name = "spots" }
    local light = g:filter { source = image, size = small, filter = fx.filters.bspline(), name = "light" }
    local lit = g:pass { shader = "lens_dirt/lit", source = light, dirt = dirt, name = "lit" }
    local up = factor == 1 and lit or g:filter { source = lit, size = source, filter = fx.filters.bspline(), name = "up" }
    return g:pass { shader = "lens_dirt/add", source = up, high = source, intensity = s.intensity, name = "final" }
  end,
}
