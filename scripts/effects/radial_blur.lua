-- SPDX-License-Identifier: MIT
-- Radial blur: a zoom while the shutter is open. Reads on the way to the centre lie in a fixed ratio to each other, so that n·m of them are n
-- reads far apart of an image that has been blurred by m reads close together: there are as many as the longest streak needs. The streaks are
-- made in a smaller picture; around the centre, where they are short, the sharp one stands. math.md §37.
local fx = require "afterglow"

-- Streaks that are longer, in pixels, are made in a picture so many times smaller; until `whole` in the one before it too, as a zoom that moves would jump.
local kWays = { { from = 0, whole = 0, side = 1 }, { from = 2, whole = 4, side = 2 }, { from = 400, whole = 600, side = 4 } }

return fx.effect {
  name = "radial_blur",
  doc = "Streaks towards a centre, as of a zoom or of speed.",
  at = "post_process", order = 82,
  settings = {
    intensity = fx.float { min = 0, max = 1, default = 0.15, doc = "Share of the way to the centre that is smeared. 0: none." },
    samples = fx.int { min = 2, max = 128, default = 16, doc = "Reads on the way, at least: long streaks take as many as they need to be even." },
    center = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "The point that stays sharp: {0, 0} is the upper left corner, {1, 1} the lower right." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  -- Positions between pixels are rounded: the more, the larger the picture; so what is read at a hard edge is off by as much.
  holds = { "black", "constant", "bounded", "monotone", "linear", continuous = 1,
            error = { fp32 = function(_, source) return 1e-3 + 2e-5 * math.max(source.width, source.height) end, fp16 = function(_, source) return 4e-3 + 2e-5 * math.max(source.width, source.height) end, up_to = 1 } },
  build = function(g, s, source)
    local amount = math.min(s.intensity, 63 / 64)
    -- To the corner that is farthest from the centre, in pixels.
    local across, down = math.max(s.center[1], 1 - s.center[1]) * source.width, math.max(s.center[2], 1 - s.center[2]) * source.height
    local length = math.sqrt(across * across + down * down) * -math.log(1 - amount)
    -- Of the picture that is delivered: a preview is small as it is.
    local whole = length / g.length_scale
    local function side(way) return way.side > 1 and math.max(1, math.floor(way.side * g.length_scale + 0.5)) or 1 end

    -- Streaks of a picture that is `factor` times smaller.
    local function streaks(factor, tag)
      local reads = math.max(s.samples, math.ceil(length / (1.5 * factor)))
      local near = math.ceil(math.sqrt(reads))
      local far = math.ceil(reads / near)
      local ratio = (1 - amount) ^ (1 / (near * far))
      local size = { (source.width + factor - 1) // factor, (source.height + factor - 1) // factor }
      local image = source
      if factor > 1 then
        image = g:filter { source = image, size = size, filter = fx.filters.area(source.width / size[1], source.height / size[2]), name = "small" .. tag }
      end
      image = g:pass { shader = "radial_blur/zoom", source = image, center = s.center, first = 1, ratio = ratio, count = near, name = "near" .. tag }
      image = g:pass { shader = "radial_blur/zoom", source = image, center = s.center, first = math.sqrt(ratio), ratio = ratio ^ near, count = far, name = "far" .. tag }
      if factor > 1 then
        image = g:filter { source = image, size = source, filter = factor > 2 and fx.filters.bspline() or fx.filters.bilinear(), name = "up" .. tag }
      end
      return g:pass { shader = "radial_blur/over", source = image, picture = source, center = { s.center[1] * source.width, s.center[2] * source.height },
                      amount = amount, factor = factor, name = "final" .. tag }
    end

    local n = 1
    while kWays[n + 1] and whole > kWays[n + 1].from do n = n + 1 end
    local way, before = kWays[n], kWays[math.max(n - 1, 1)]
    local fine, coarse, share = side(before), side(way), (whole - way.from) / (way.whole - way.from)
    if share >= 1 or fine == coarse then return streaks(coarse, "") end
    return g:pass { shader = "bloom/scatter", source = streaks(coarse, "_coarse"), high = streaks(fine, ""), amount = share, name = "mix" }
  end,
}
