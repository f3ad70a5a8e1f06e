-- SPDX-License-Identifier: MIT
-- Bloom: light that is too bright for the picture spreads around itself.
-- A Gaussian pyramid of the light above a soft threshold, added to or scattered over the picture.
-- After Catlike Coding, "Custom SRP" parts 11 (Post Processing) and 12 (HDR): passes, weights and order are theirs.
local fx = require "afterglow"
local pyramids = require "lib.pyramid"

local kScatterLimit = 0.95  -- in scattering mode the picture itself always contributes

-- A threshold is given as a display value: sRGB below 1, and a plain power from 1 on, as Unity reads it.
local function gamma_to_linear(v)
  if v <= 0.04045 then return v / 12.92 end
  if v < 1 then return ((v + 0.055) / 1.055) ^ 2.4 end
  return v ^ 2.2
end

-- (t, tk − t, 2tk, 0.25/(tk + 1e-5)); see shaders/lib/soft_knee.glsl. The bound keeps the numbers within 32-bit floats.
local function knee_vector(s)
  local t = math.min(gamma_to_linear(s.threshold), 1e37)
  local tk = t * s.knee
  return { t, tk - t, 2 * tk, 0.25 / (tk + 1e-5) }
end

-- Size of the picture whose glow is made: of the source, or as it would be at reference_height.
local function size_of(s, source)
  if s.reference_height == 0 then return source.width, source.height end
  local height = s.reference_height
  local width = math.max(1, (2 * source.width * height + source.height) // (2 * source.height))
  if width > 16384 then error(("reference_height = %d makes the picture %d wide; at most 16384 is possible"):format(height, width), 0) end
  return width, height
end

-- What a halving blurs, without the halving.
local function same_size_blur()
  local taps = fx.filters.gaussian_vertical().y
  return { interpolation = "linear", x = taps, y = taps }
end

-- Filters stretch what lies at the edges of their source unless they are told otherwise.
local function with_edges(filter, edges)
  filter.edges = edges
  return filter
end

-- Levels of the pyramid for a picture, and whether every size on the way down is half of the one before.
local function pyramid(s, source)
  local width, height = size_of(s, source)
  local levels, even = 0, s.reference_height == 0 and width % 2 == 0 and height % 2 == 0
  width, height = width // 2, height // 2
  if width < 2 * s.downscale_limit or height < 2 * s.downscale_limit then return 0, true end
  even = even and width % 2 == 0 and height % 2 == 0
  width, height = width // 2, height // 2
  while levels < s.max_iterations and width >= s.downscale_limit and height >= s.downscale_limit do
    levels = levels + 1
    even = even and (levels == s.max_iterations or width % 2 == 0 and height % 2 == 0 or width // 2 < s.downscale_limit or height // 2 < s.downscale_limit)
    width, height = width // 2, height // 2
  end
  return levels, even
end

local function is_even(s, source)
  local _, even = pyramid(s, source)
  return even
end

-- Pixels that light reaches, generously: nine reads two texels apart at each level, and four on the way up.
local function reach(s, source) return 24 * 2 ^ pyramid(s, source) end
-- Light whose sum stays has to be that far from the edges, unless the picture is mirrored there. (The filter of fireflies stretches it.)
local function from_edges(s, source)
  if s.edges ~= "mirror" then return reach(s, source) end
  return s.fade_fireflies and 4 or 0
end

local function passes_all(s) return s.threshold == 0 and not s.fade_fireflies end
local function is_linear(s) return passes_all(s) and s.clamp == 0 and s.intensity <= 1 end
local function scatters(s) return s.mode == "scattering" end

return fx.effect {
  name = "bloom",
  doc = "Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.",
  at = "post_process", order = 100, space = "scene",
  settings = {
    mode = fx.enum { "additive", "scattering", default = "additive",
      doc = "additive: glow is added, the picture gets brighter. scattering: light is spread as in a lens, its sum stays." },
    max_iterations = fx.int { min = 0, max = 16, default = 16, doc = "Most levels of the pyramid; each doubles the reach. 0: no bloom." },
    downscale_limit = fx.int { min = 1, default = 2, unit = "texels",
      doc = "No level gets smaller than this on either side; pictures below four times this get no bloom." },
    threshold = fx.float { min = 0, default = 1.0,
      doc = "Brightness (largest channel) from which light blooms, as a display (gamma) value: 1 is white, 2 is linear 4.59." },
    knee = fx.float { min = 0, max = 1, default = 0.5,
      doc = "Softness of the threshold: blooming begins at (1 - knee) of the linear threshold and is full from (1 + knee) on." },
    intensity = fx.float { min = 0, default = 0.2,
      doc = "Strength. additive: factor of the glow. scattering: share of the spread light, held to 0.95. 0: no bloom." },
    scatter = fx.float { min = 0.05, max = 0.95, default = 0.7,
      doc = "Scattering mode: how far light spreads, as the share that each level takes from the coarser ones." },
    bicubic_upsampling = fx.bool { default = true, doc = "Enlarge levels with cubic B-splines instead of bilinearly: smoother, less blocky glow." },
    reference_height = fx.int { min = 0, max = 16384, default = 0, unit = "lines",
      doc = "The glow is that of the picture scaled to this height: the same at every resolution. 0: of the picture as it is." },
    clamp = fx.float { min = 0, max = 65504, default = 0,
      doc = "Light that is brighter than this (largest channel, linear) glows as if it were this bright, so that single wild pixels do not white out a picture; for path-traced pictures about 50. 0: no limit." },
    edges = fx.enum { "stretch", "mirror", default = "stretch",
      doc = "What is taken to lie outside of the picture: its last pixels, which makes light at the edges glow more, in corners four times as much, or its mirror image, with which it glows as everywhere." },
    fade_fireflies = fx.bool { default = false, doc = "Weigh down isolated very bright pixels before the pyramid, so that they do not flicker." },
  },

  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    if s.max_iterations == 0 then return false, "max_iterations is 0" end
    return true
  end,

  -- Light below (1 - knee) of the threshold does not bloom. Half the size of an even picture is the mean of four texels, never above
  -- the largest of them; other sizes weigh texels with rounded numbers, which may lift the mean by some 1e-7.
  idle = function(s, source, length_scale)
    local knee = knee_vector(s)
    local even = source.width % 2 == 0 and source.height % 2 == 0
    local slack = (s.reference_height > 0 or length_scale ~= 1) and 1e-5 or even and 0 or 1e-6
    return { brightest = -knee[2] * (1 - slack) }
  end,

  holds = {
    "black", "constant", "mirror", "turn_180",
    mean = { within = 1e-4, margin = from_edges, when = function(s, source) return scatters(s) and passes_all(s) and is_even(s, source) end },
    no_added_light = { within = 1e-4, margin = from_edges, when = function(s, source) return scatters(s) and is_even(s, source) end },
    bounded = { when = scatters },
    monotone = { when = function(s) return not s.fade_fireflies end },
    continuous = { slope = function(s, source)
      local gain = scatters(s) and math.min(s.intensity, kScatterLimit) or s.intensity * pyramid(s, source)
      return 1 + gain * (s.fade_fireflies and 6 or 1)
    end },
    linear = { within = 1e-3, when = is_linear },
    proportional = { setting = "intensity", up_to = function(s) return scatters(s) and kScatterLimit or 10 end },
    turn_90 = { margin = reach, when = is_even },
    shift = { by = function(s, source) return 2 ^ (pyramid(s, source) + 1) end, margin = reach, when = is_even },
    -- What is added is multiplied by the intensity, and so are the steps of half floats near 0, 6e-8, of some levels: beyond 44 they count most.
    -- Tails of lights that are bright enough for a threshold above 30 (in linear light, 1,800) end in steps of half floats, too.
    error = { fp32 = 1e-5, fp16 = function(s) return math.max(s.threshold > 30 and 5e-3 or 2e-3, scatters(s) and 0 or 4.5e-5 * s.intensity) end, levels = "max_iterations" },
  },
  build = function(g, s, source)
    -- The picture whose glow is made. A preview stands for the delivered one, whose levels are counted.
    local full_width, full_height = size_of(s, source)
    local preview = s.reference_height == 0 and g.length_scale < 1
    if s.reference_height == 0 then full_width, full_height = pyramids.delivered(g, source) end
    local width, height = full_width // 2, full_height // 2
    if width < 2 * s.downscale_limit or height < 2 * s.downscale_limit then
      g:skip(("the picture is too small: %dx%d, downscale_limit %d needs %d on each side"):format(
        full_width, full_height, s.downscale_limit, 4 * s.downscale_limit))
      return source
    end

    -- Sizes: half of the picture, then level 0, which is a quarter of it per axis. They are floored at each halving.
    local sizes = { { width, height } }
    width, height = width // 2, height // 2
    while #sizes <= s.max_iterations and width >= s.downscale_limit and height >= s.downscale_limit do
      sizes[#sizes + 1] = { width, height }
      width, height = width // 2, height // 2
    end

    local knee, most = knee_vector(s), s.clamp > 0 and s.clamp or 1e30
    local start = preview and pyramids.start(sizes, source.width, source.height) or 1
    local image = source
    if s.clamp > 0 then image = g:pass { shader = "bloom/hold", source = image, most = most, name = "hold" } end
    local enlarged = s.fade_fireflies and source.height < full_height
    if enlarged then  -- once they are enlarged, single pixels are none any more
      image = g:pass { shader = "bloom/fireflies", source = image, size = image, knee = knee, reach = 3, name = "prefilter" }
      image = pyramids.resized(g, image, sizes[start][1], sizes[start][2], "scaled")
    elseif start == 1 then
      image = pyramids.resized(g, image, full_width, full_height, "scaled")
      if s.fade_fireflies then
        image = g:pass { shader = "bloom/fireflies", source = image, size = sizes[1], knee = knee, reach = 3, name = "prefilter" }
      else
        image = g:filter { source = image, size = sizes[1], filter = fx.filters.bilinear(), name = "half" }
      end
    else
      image = pyramids.resized(g, image, sizes[start][1], sizes[start][2], "scaled")
    end
    if not enlarged and not (start == 1 and s.fade_fireflies) then
      image = g:pass { shader = "bloom/threshold", source = image, knee = knee, name = "prefilter" }
    end
    local light = image

    -- Down. A preview's own pixels, blurred as that level would be, are its first level.
    local levels = {}
    if start > 1 then levels[1] = g:filter { source = image, filter = with_edges(same_size_blur(), s.edges), name = ("level[%d]"):format(start - 2) } end
    image = levels[1] or image
    for i = start + 1, #sizes do
      image = g:filter { source = image, size = sizes[i], filter = with_edges(fx.filters.gaussian_halving(), s.edges), name = ("horizontal[%d]"):format(i - 2) }
      image = g:filter { source = image, size = image, filter = with_edges(fx.filters.gaussian_vertical(), s.edges), name = ("vertical[%d]"):format(i - 2) }
      levels[#levels + 1] = image
    end

    -- Up: from the coarsest level to the finest.
    local enlarge = with_edges(s.bicubic_upsampling and fx.filters.bspline() or fx.filters.bilinear(), s.edges)
    local additive = s.mode == "additive"
    for i = #levels - 1, 1, -1 do
      local up = g:filter { source = image, size = levels[i], filter = enlarge, name = ("up[%d]"):format(i - 1) }
      local name = ("combine[%d]"):format(i - 1)
      if additive then
        image = g:pass { shader = "bloom/add", source = up, high = levels[i], intensity = 1, name = name }
      else
        image = g:pass { shader = "bloom/scatter", source = up, high = levels[i], amount = s.scatter, name = name }
      end
    end
    -- Levels that are finer than the preview look like it.
    if start > 2 then
      if additive then
        image = g:pass { shader = "bloom/add", source = light, high = image, intensity = start - 2, name = "finer" }
      else
        image = g:pass { shader = "bloom/scatter", source = image, high = light, amount = s.scatter ^ (start - 2), name = "finer" }
      end
    end

    local up = g:filter { source = image, size = source, filter = enlarge, name = "up" }
    if additive then
      return g:pass { shader = "bloom/add", source = up, high = source, intensity = math.min(s.intensity, 1e30), name = "final" }
    end
    return g:pass { shader = "bloom/scatter_final", source = up, high = source, amount = math.min(s.intensity, kScatterLimit),
                    knee = knee, most = most, name = "final" }
  end,
}
