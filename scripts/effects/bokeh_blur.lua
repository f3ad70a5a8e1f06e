-- SPDX-License-Identifier: MIT
-- Bokeh blur: out of focus as through an iris, everywhere alike (`depth_of_field` looks at distance). Wide irises work on a smaller picture. math.md §36.
local fx = require "afterglow"

-- How an iris that is as wide as a round one of at least `from` pixels is read: on a picture whose pixels are `side` pixels of the source wide, at every `step`th of them.
-- An iris of `from` pixels is four of the smaller pixels wide or more, but for the narrowest: that many reads take as long as the picture is worth.
local kWays = {
  { from = 0, side = 1, step = 1 }, { from = 3.3, side = 1, step = 2 }, { from = 5, side = 2, step = 1 }, { from = 11, side = 3, step = 1 },
  { from = 16, side = 4, step = 1 }, { from = 28, side = 6, step = 1 }, { from = 40, side = 8, step = 1 }, { from = 56, side = 12, step = 1 },
  { from = 80, side = 16, step = 1 }, { from = 112, side = 24, step = 1 }, { from = 160, side = 32, step = 1 }, { from = 224, side = 48, step = 1 },
  { from = 320, side = 64, step = 1 }, { from = 448, side = 96, step = 1 },
}
local kMostTurns = 90  -- in search of the iris that is as wide as the lens's; ten as a rule
local kWidest = 672  -- pixels: 64 at a tenth of this size, and as many reads as a filter has

-- Mean square of a filter's offsets, whose weights sum up to 1.
local function variance(taps)
  local sum = 0
  for _, tap in ipairs(taps) do sum = sum + tap[2] * tap[1] ^ 2 end
  return sum
end

-- A tent of `side` texels to both sides at those next to it: a light that moves moves as far in the smaller picture.
local function tent(side)
  local taps = {}
  for i = 1, 2 * side do
    local at = i - side - 0.5
    if side % 2 == 1 then at = at - 0.5 end  -- the middle of an odd number of texels is one
    if math.abs(at) < side then taps[#taps + 1] = { at, (1 - math.abs(at) / side) / side } end
  end
  return taps
end

-- The same with one read for two texels, where the smaller picture's pixels cover whole ones.
local function pairwise(taps)
  local pairs_of = {}
  for i = 1, #taps, 2 do
    local first, second = taps[i], taps[i + 1] or { 0, 0 }
    local weight = first[2] + second[2]
    pairs_of[#pairs_of + 1] = { first[1] + second[2] / weight, weight }
  end
  return pairs_of
end

-- What the way blurs beside the iris, per axis in square pixels, but for the rim: the tent on the way down, the fill of texels that
-- are not read, and the way up (bilinear: a tent, B-spline: twice as much).
local function aside(way)
  local side = way.side
  if side == 1 then return way.step == 2 and 0.5 or 0 end
  return variance(tent(side)) + side ^ 2 / (side > 2 and 3 or 6)
end

-- The way for the radius of a round iris, and how wide the rim is that its texels' shares of the iris make, in pixels. It grows from that of one texel until all is as soft as the next way is: a moving radius shows no step.
local function way_for(radius)
  local n = 1
  while kWays[n + 1] and radius >= kWays[n + 1].from do n = n + 1 end
  local way, next_way = kWays[n], kWays[n + 1]
  local spacing = way.side * way.step
  local least = spacing ^ 2 / 12
  local soft = aside(way) + least
  if next_way then
    local part = (radius ^ 2 - way.from ^ 2) / (next_way.from ^ 2 - way.from ^ 2)
    soft = soft + part ^ 2 * (aside(next_way) + (next_way.side * next_way.step) ^ 2 / 12 - soft)
  end
  return way, math.sqrt(12 * (soft - aside(way)))
end

-- An iris with `blades` straight sides (fewer than 3: round): how far away each side's middle lies, as x and y of what a point is multiplied by.
local function iris_of(blades, turn)
  local sides, narrow = {}, math.cos(math.pi / math.max(blades, 3))
  for i = 1, blades >= 3 and blades or 0 do
    local angle = turn + 2 * math.pi * (i - 0.5) / blades
    sides[i] = { math.cos(angle) / narrow, math.sin(angle) / narrow }
  end
  -- `steepest`: how much farther a point may be for one pixel aside; `as_round`: radius of the round iris that blurs as much, to that of the circle around this one.
  local as_round = blades < 3 and 1 or math.sqrt((2 + math.cos(2 * math.pi / blades)) / 3)
  return { sides = sides, steepest = blades < 3 and 1 or 1 / narrow, as_round = as_round }
end

-- Radius of the smallest iris that has the point on its rim.
local function iris_radius(x, y, iris)
  if #iris.sides == 0 then return math.sqrt(x * x + y * y) end
  local radius = 0
  local sides = iris.sides
  for i = 1, #sides do
    local away = x * sides[i][1] + y * sides[i][2]
    if away > radius then radius = away end
  end
  return radius
end

-- Share of a square of `width` around the point that lies in the iris, by its sixteenths.
local function share(x, y, width, radius, iris)
  local away = radius - iris_radius(x, y, iris)
  if math.abs(away) > width * iris.steepest then return away > 0 and 1 or 0 end
  local part, sum = width / 4, 0
  for j = -1.5, 1.5 do
    for i = -1.5, 1.5 do
      local rim = iris_radius(x + i * part, y + j * part, iris)
      sum = sum + math.min(math.max((radius - rim) / part + 0.5, 0), 1) / 16
    end
  end
  return sum
end

-- The iris as reads of every `step`th texel. Lengths in texels; `rim`: width of the square whose share a texel's weight is.
local function reads_of(radius, iris, step, rim)
  local taps, sum = {}, 0
  local reach = math.ceil((radius + rim) / step)
  for j = -reach, reach do
    for i = -reach, reach do
      local weight = share(i * step, j * step, rim, radius, iris)
      if weight > 0 then
        taps[#taps + 1] = { i * step, j * step, weight }
        sum = sum + weight
      end
    end
  end
  if sum == 0 then return { taps = { { 0, 0, 1 } } } end  -- an iris that lies between the sixteenths of one texel
  for _, tap in ipairs(taps) do tap[3] = tap[3] / sum end
  return { taps = taps }
end

-- The reads that blur, with what else does, as much as an iris of `radius` pixels would alone: their mean square is what is left to them.
local function compensated(radius, iris, way, rim)
  local wanted = iris.as_round ^ 2 * radius ^ 2 / 4 - aside(way)
  local function reads(wide)
    local filter, made = reads_of(wide / way.side, iris, way.step, rim / way.side), 0
    for _, tap in ipairs(filter.taps) do made = made + tap[3] * (tap[1] ^ 2 + tap[2] ^ 2) / 2 * way.side ^ 2 end
    return filter, made - wanted
  end
  local low, high = radius / 2, 2 * radius + way.side * way.step
  local filter, off = reads(low)
  if off >= 0 then return filter end
  local off_low, off_high = off, select(2, reads(high))
  for turn = 1, kMostTurns do
    -- By the line between both ends, where an end that stays counts half as much (Illinois); each fourth time by halves, for the curve has a corner
    -- where the iris comes to the next texel.
    local wide, before = turn % 4 == 0 and (low + high) / 2 or high - off_high * (high - low) / (off_high - off_low), off
    filter, off = reads(wide)
    if math.abs(off) <= 1e-7 * wanted then break end
    if off < 0 then
      low, off_low = wide, off
      if before < 0 and turn > 1 then off_high = off_high / 2 end
    else
      high, off_high = wide, off
      if before >= 0 then off_low = off_low / 2 end
    end
  end
  return filter
end

local function smaller(g, image, side)
  local function axis(size)
    local taps = tent(side)
    return size % side == 0 and pairwise(taps) or taps
  end
  local size = { (image.width + side - 1) // side, (image.height + side - 1) // side }
  return g:filter { source = image, size = size, filter = { interpolation = "linear", x = axis(image.width), y = axis(image.height) }, name = "small" }
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
    local radius = math.min(s.radius, kWidest)
    local iris = iris_of(s.blades, s.rotation * math.pi / 180)
    local way, rim = way_for(radius * iris.as_round)
    local side = way.side
    if side > 1 then image = smaller(g, image, side) end
    image = g:filter { source = image, filter = compensated(radius, iris, way, rim), name = "iris" }
    if way.step == 2 then image = g:filter { source = image, filter = fx.filters.box(0.5), name = "fill" } end
    if side > 1 then
      local up = side > 2 and fx.filters.bspline() or fx.filters.bilinear()
      image = g:filter { source = image, size = source, filter = up, name = "up" }
    end
    if s.highlights > 0 then return g:pass { shader = "bokeh_blur/divide", source = image, picture = source, name = "final" } end
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
