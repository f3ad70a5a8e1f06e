-- Bloom: light that is too bright for the picture spreads around itself.
-- A Gaussian pyramid of the light above a soft threshold, added to or scattered over the picture.
-- After Catlike Coding, "Custom SRP" parts 11 (Post Processing) and 12 (HDR): passes, weights and order are theirs.
local fx = require "afterglow"

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

-- The picture as it would be at that height: halved while that leaves at least as much, then the mean over what is left.
local function scaled(g, source, height)
  local width = math.max(1, (2 * source.width * height + source.height) // (2 * source.height))
  local image, i = source, 0
  local function to(size, filter)
    image = g:filter { source = image, size = size, filter = filter, name = ("scaled[%d]"):format(i) }
    i = i + 1
  end
  while image.height >= 2 * height and image.width >= 2 * width do
    to({ image.width // 2, image.height // 2 }, fx.filters.bilinear())
  end
  if image.width ~= width or image.height ~= height then
    to({ width, height }, fx.filters.area(image.width / width, image.height / height))
  end
  return image
end

return fx.effect {
  name = "bloom",
  doc = "Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.",
  at = "post_process", order = 100,
  settings = {
    mode = fx.enum { "additive", "scattering", default = "additive",
      doc = "additive: glow is added, the picture gets brighter. scattering: light is spread as in a lens, its sum stays." },
    max_iterations = fx.int { min = 0, max = 16, default = 16, doc = "Most levels of the pyramid; each doubles the reach. 0: no bloom." },
    downscale_limit = fx.int { min = 1, default = 2, unit = "px",
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
    reference_height = fx.int { min = 0, max = 16384, default = 0, unit = "px",
      doc = "The glow is that of the picture scaled to this height: the same at every resolution. 0: of the picture as it is." },
    fade_fireflies = fx.bool { default = false, doc = "Weigh down isolated very bright pixels before the pyramid, so that they do not flicker." },
  },

  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    if s.max_iterations == 0 then return false, "max_iterations is 0" end
    return true
  end,

  -- Light below (1 - knee) of the threshold does not bloom. Half the size of an even picture is the mean of four texels, never above
  -- the largest of them; other sizes weigh texels with rounded numbers, which may lift the mean by some 1e-7.
  idle = function(s, source)
    local knee = knee_vector(s)
    local even = source.width % 2 == 0 and source.height % 2 == 0
    local slack = s.reference_height > 0 and 1e-5 or even and 0 or 1e-6
    return { brightest = -knee[2] * (1 - slack) }
  end,

  build = function(g, s, source)
    local picture = s.reference_height > 0 and scaled(g, source, s.reference_height) or source
    local width, height = picture.width // 2, picture.height // 2
    if width < 2 * s.downscale_limit or height < 2 * s.downscale_limit then
      g:skip(("the picture is too small: %dx%d, downscale_limit %d needs %d on each side"):format(
        picture.width, picture.height, s.downscale_limit, 4 * s.downscale_limit))
      return source
    end

    local knee = knee_vector(s)
    local image
    if s.fade_fireflies then
      image = g:pass { shader = "bloom/fireflies", source = picture, size = { width, height }, knee = knee, reach = 3, name = "prefilter" }
    else
      image = g:filter { source = picture, size = { width, height }, filter = fx.filters.bilinear(), name = "half" }
      image = g:pass { shader = "bloom/threshold", source = image, knee = knee, name = "prefilter" }
    end

    -- Down: level 0 is a quarter of the picture per axis. Sizes are floored at each halving.
    local levels = {}
    width, height = width // 2, height // 2
    while #levels < s.max_iterations and width >= s.downscale_limit and height >= s.downscale_limit do
      local i = #levels
      image = g:filter { source = image, size = { width, height }, filter = fx.filters.gaussian_halving(), name = ("horizontal[%d]"):format(i) }
      image = g:filter { source = image, size = image, filter = fx.filters.gaussian_vertical(), name = ("vertical[%d]"):format(i) }
      levels[i + 1] = image
      width, height = width // 2, height // 2
    end

    -- Up: from the coarsest level to the finest.
    local enlarge = s.bicubic_upsampling and fx.filters.bspline() or fx.filters.bilinear()
    for i = #levels - 1, 1, -1 do
      local up = g:filter { source = image, size = levels[i], filter = enlarge, name = ("up[%d]"):format(i - 1) }
      local name = ("combine[%d]"):format(i - 1)
      if s.mode == "additive" then
        image = g:pass { shader = "bloom/add", source = up, high = levels[i], intensity = 1, name = name }
      else
        image = g:pass { shader = "bloom/scatter", source = up, high = levels[i], amount = s.scatter, name = name }
      end
    end

    local up = g:filter { source = image, size = source, filter = enlarge, name = "up" }
    if s.mode == "additive" then
      return g:pass { shader = "bloom/add", source = up, high = source, intensity = math.min(s.intensity, 1e30), name = "final" }
    end
    return g:pass { shader = "bloom/scatter_final", source = up, high = source, amount = math.min(s.intensity, kScatterLimit),
                    knee = knee, name = "final" }
  end,
}
