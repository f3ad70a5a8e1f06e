-- SPDX-License-Identifier: MIT
-- Bokeh blur: out of focus as through an iris, everywhere alike (`depth_of_field` looks at distance). Wide irises work on a smaller picture. There
-- every second texel of the iris is read across and down, and the mean of 2×2 pixels fills the gaps between them exactly. math.md §36.
local fx = require "afterglow"

-- Radius of the smallest iris with `blades` straight sides (fewer than 3: round) that has the point on its rim.
local function iris_radius(x, y, blades, turn)
  if blades < 3 then return math.sqrt(x * x + y * y) end
  local radius = 0
  for i = 1, blades do
    local angle = turn + 2 * math.pi * (i - 0.5) / blades
    radius = math.max(radius, (x * math.cos(angle) + y * math.sin(angle)) / math.cos(math.pi / blades))
  end
  return radius
end

-- Every `step`th texel of an iris; the rim is as soft as steps are long. `side`: that of a texel, in pixels.
local function iris(radius, blades, turn, step, side)
  local spacing, taps, sum = step * side, {}, 0
  local reach = math.ceil(radius / spacing + 0.5)
  for j = -reach, reach do
    for i = -reach, reach do
      local weight = math.min(math.max(radius / spacing - iris_radius(i, j, blades, turn) + 0.5, 0), 1)
      if weight > 0 then
        taps[#taps + 1] = { i * step, j * step, weight }
        sum = sum + weight
      end
    end
  end
  for _, tap in ipairs(taps) do tap[3] = tap[3] / sum end
  return { taps = taps }
end

-- Side of a pixel of the smaller picture for an iris of `radius` pixels.
local function factor_for(radius)
  if radius <= 4 then return 1 end
  if radius <= 14 then return 2 end
  local factor = 4
  while radius > 16 * factor do factor = 2 * factor end
  return factor
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
    local image = source
    if s.highlights > 0 then
      image = g:pass { shader = "bokeh_blur/weigh", source = image, highlights = s.highlights, name = "weigh" }
    end
    local factor = factor_for(s.radius)
    local width, height = (source.width + factor - 1) // factor, (source.height + factor - 1) // factor
    if factor > 1 then
      image = g:filter { source = image, size = { width, height }, filter = fx.filters.area(source.width / width, source.height / height), name = "small" }
    end
    -- What the means blur by themselves is taken off: variances add up, r²/4 of a disc and 1/12 of a square's side squared.
    local step = s.radius > 2 * factor and 2 or 1
    local means = (step == 2 and 4 or 0) + (factor > 1 and 1 or 0)
    local radius = math.sqrt(math.max(s.radius * s.radius - means / 3 * factor * factor, 0))
    if step == 1 then radius = s.radius end
    image = g:filter { source = image, filter = iris(radius, s.blades, s.rotation * math.pi / 180, step, factor), name = "iris" }
    if step == 2 then image = g:filter { source = image, filter = fx.filters.box(0.5), name = "fill" } end
    if factor > 1 then
      local up = factor > 2 and fx.filters.bspline() or fx.filters.bilinear()
      image = g:filter { source = image, size = source, filter = up, name = "up" }
    end
    if s.highlights > 0 then return g:pass { shader = "bokeh_blur/divide", source = image, picture = source, name = "final" } end
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
