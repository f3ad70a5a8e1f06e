-- SPDX-License-Identifier: MIT
-- Dual Kawase blur: the cheapest wide blur there is, five reads a level down and eight up. After M. Bjørge, "Bandwidth-Efficient Rendering",
-- SIGGRAPH 2015 (ARM). Frosted glass behind titles and menus, dreamy overlays. Halving an odd number, reads wander from between texels onto
-- them, where some texels would count twice and their neighbours not at all: along such a side each read is two, half a texel to both sides.
local fx = require "afterglow"
local pyramids = require "lib.pyramid"

-- Five reads for a picture of this size.
local function down(width, height, o)
  local taps = {}
  local dx, dy = width % 2 == 1 and { -0.5, 0.5 } or { 0 }, height % 2 == 1 and { -0.5, 0.5 } or { 0 }
  for _, read in ipairs { { 0, 0, 1 / 2 }, { -o, -o, 1 / 8 }, { o, -o, 1 / 8 }, { -o, o, 1 / 8 }, { o, o, 1 / 8 } } do
    for _, y in ipairs(dy) do
      for _, x in ipairs(dx) do taps[#taps + 1] = { read[1] + x, read[2] + y, read[3] / (#dx * #dy) } end
    end
  end
  return { taps = taps }
end

return fx.effect {
  name = "dual_kawase",
  doc = "A wide, smooth, cheap blur of the whole picture.",
  at = "post_process", order = 80,
  settings = {
    iterations = fx.int { min = 0, max = 12, default = 3, doc = "Halvings of the picture; each doubles the blur. 0: none." },
    offset = fx.float { min = 0, max = 3, default = 1, doc = "Distance of the reads: widens the blur smoothly between two counts of iterations; large ones show a pattern. In 1024ths of a pixel." },
  },
  active = function(s) return s.iterations > 0, "iterations is 0" end,

  holds = { "black", "constant", "bounded", "monotone", "linear", "mirror", "turn_180", "turn_90", continuous = 1, error = { fp32 = 1e-5, fp16 = 2e-3, levels = "iterations" } },
  build = function(g, s, source)
    local o = math.floor(s.offset * 1024 + 0.5) / 1024  -- exact in floats: mirrored reads weigh the same
    local h = o / 2
    local up = { taps = { { -o, 0, 1 / 12 }, { o, 0, 1 / 12 }, { 0, -o, 1 / 12 }, { 0, o, 1 / 12 },
                          { -h, -h, 1 / 6 }, { h, -h, 1 / 6 }, { -h, h, 1 / 6 }, { h, h, 1 / 6 } } }

    local width, height = pyramids.delivered(g, source)
    local sizes = { { width, height } }
    while #sizes <= s.iterations and width > 1 and height > 1 do
      width, height = width // 2, height // 2
      sizes[#sizes + 1] = { width, height }
    end
    if #sizes == 1 then
      g:skip("the picture is a single row or column")
      return source
    end
    local start, image = 1, source
    if g.length_scale ~= 1 then
      if g.length_scale < 1 then start = pyramids.start(sizes, source.width, source.height) end
      image = pyramids.resized(g, source, sizes[start][1], sizes[start][2], "scaled")
    end
    for i = start + 1, #sizes do
      image = g:filter { source = image, size = sizes[i], filter = down(image.width, image.height, o), name = ("down[%d]"):format(i - 2) }
    end
    for i = #sizes - 1, start, -1 do image = g:filter { source = image, size = sizes[i], filter = up, name = ("up[%d]"):format(i - 1) } end
    if image.width ~= source.width or image.height ~= source.height then
      image = g:filter { source = image, size = source, filter = fx.filters.bilinear(), name = "preview" }
    end
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
