-- SPDX-License-Identifier: MIT
-- Image overlay: a picture of yours over the picture: a logo, a frame, dust, scratches, a leak of light. One that moves is a sequence whose name a
-- function of `t` gives. Pictures that are to be smaller are made so once; larger ones are read between their texels, by a cubic that does not
-- ring. Over transparent parts its light is light alone, as that of burn_in. Formulas: docs/math.md §56.
local fx = require "afterglow"
local placed = require "lib.placed"

-- Numbers: shaders/lib/blend.glsl.
local blends = { normal = 0, add = 1, screen = 2, multiply = 3, overlay = 4, soft_light = 5, lighten = 6, darken = 7,
  hard_light = 8, color = 9, luminosity = 10 }

return fx.effect {
  name = "image_overlay",
  doc = "A picture from a file over the picture: a logo, dust, a leak of light.",
  at = "after_post_process", order = 210,
  settings = {
    file = fx.file { extensions = { "png", "exr", "tif", "tiff", "hdr", "jpg", "jpeg", "webp" }, doc = "The picture, with its alpha. None: no effect. Numbered ones: `function(t) return (\"leak.%04d.png\"):format(t.frame) end`." },
    blend = fx.enum { "normal", "add", "screen", "multiply", "overlay", "soft_light", "lighten", "darken", "hard_light", "color", "luminosity", default = "normal", doc = "How it is laid over. add, screen: light on black; multiply: shade on white." },
    fit = fx.enum { "cover", "contain", "stretch", "tile", default = "contain", doc = "contain: as large as fits in; cover: so that nothing is left free; stretch: the shape of the picture; tile: in its own size, again and again." },
    size = fx.float { min = 0.001, max = 100, default = 1, doc = "Factor of the size that fit gives. 0.1 of contain: a logo." },
    position = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "Where it is: {0, 0} in the upper left corner, {1, 1} in the lower right. Held to whole pixels, so that what is sharp stays sharp." },
    margin = fx.float { min = 0, max = 0.4, default = 0, doc = "Kept free at the picture's border, as a share of its height. Not of tiles." },
    intensity = fx.float { min = 0, max = 100, default = 1, doc = "Factor of its light." },
  },
  active = function(s) return s.file ~= "", "file is not given", true end,
  build = function(g, s, source)
    local tile = s.fit == "tile"
    local margin = tile and 0 or math.min(s.margin * source.height, 0.4 * source.width)
    local room = { source.width - 2 * margin, source.height - 2 * margin }
    local size, over = placed.sized(g, g:image { file = s.file }, room, s.fit, s.size)
    return g:pass {
      shader = "image_overlay/over", source = source, over = over, intensity = s.intensity,
      corner = placed.corner(room, size, s.position, margin), extent = size,
      blend = blends[s.blend], tile = tile, larger = over.width ~= size[1] or over.height ~= size[2],
    }
  end,
}
