-- SPDX-License-Identifier: MIT
-- Bokeh blur: out of focus as through an iris, everywhere alike (`depth_of_field` looks at distance). Reads on rings over the iris, then a
-- small disc that fills the gaps between them.
local fx = require "afterglow"

local kRings = 4

-- How far the rim of an iris with `blades` straight sides reaches at an angle; a circle reaches 1.
local function rim(angle, blades)
  if blades < 3 then return 1 end
  local side = 2 * math.pi / blades
  return math.cos(side / 2) / math.cos(angle % side - side / 2)
end

-- Rings 0…`count`, `spacing` apart: each point stands for the same area, but for the first, whose disc is three quarters of one.
local function rings(count, spacing, blades, turn)
  local taps, weight = { { 0, 0, 0.75 } }, 0.75
  for ring = 1, count do
    for i = 0, 6 * ring - 1 do
      local angle = 2 * math.pi * i / (6 * ring)
      local r = ring * spacing * rim(angle, blades)
      taps[#taps + 1] = { r * math.cos(angle + turn), r * math.sin(angle + turn), 1 }
      weight = weight + 1
    end
  end
  for _, tap in ipairs(taps) do tap[3] = tap[3] / weight end
  return { taps = taps }
end

return fx.effect {
  name = "bokeh_blur",
  doc = "Blurs the picture as a lens out of focus: bright points become discs or polygons.",
  at = "post_process", order = 86,
  settings = {
    radius = fx.float { min = 0, max = 64, default = 8, unit = "px", doc = "Radius of the iris. 0: none." },
    blades = fx.int { min = 0, max = 12, default = 0, doc = "Sides of the iris, 3 or more; fewer: round." },
    rotation = fx.float { min = -180, max = 180, default = 0, unit = "degrees", doc = "Turns the iris." },
    highlights = fx.float { min = 0, max = 50, default = 0,
      doc = "Makes bright points count for more, where the picture lost their true light (8 bits); HDR pictures need none." },
  },
  active = function(s) return s.radius > 0, "radius is 0" end,
  holds = {
    "black", "constant",
    "bounded", monotone = { when = function(s) return s.highlights == 0 end },
    linear = { when = function(s) return s.highlights == 0 end },
    continuous = { slope = 1, when = function(s) return s.highlights == 0 end },
    error = { fp32 = 5e-4, fp16 = 4e-3, up_to = 50 },
  },
  build = function(g, s, source)
    local spacing = s.radius / (kRings + 0.5)
    local image = source
    if s.highlights > 0 then
      image = g:pass { shader = "bokeh_blur/weigh", source = image, highlights = s.highlights, name = "weigh" }
    end
    image = g:filter { source = image, filter = rings(kRings, spacing, s.blades, s.rotation * math.pi / 180), name = "rings" }
    image = g:filter { source = image, filter = rings(1, spacing / 2, 0, 0), name = "fill" }
    if s.highlights > 0 then return g:pass { shader = "bokeh_blur/divide", source = image, picture = source, name = "final" } end
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
