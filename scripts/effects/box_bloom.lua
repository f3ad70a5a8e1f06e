-- SPDX-License-Identifier: MIT
-- Box bloom: a cheaper, harder bloom with a linear threshold and four-sample blurs, good for display-referred pictures.
-- After "Unity post-processing: bloom by box blur" tutorials; where their listings disagree or read an image while it is written, the
-- well-defined reading is taken: the way up starts at the second coarsest level and uses the stored sizes.
local fx = require "afterglow"
local pyramids = require "lib.pyramid"

return fx.effect {
  name = "box_bloom",
  doc = "A simple, punchy glow, as its source makes it: hard linear threshold, four-sample blur down and up, added to the picture. Its glow has corners; that of bloom is round.",
  at = "post_process", order = 100,
  settings = {
    threshold = fx.float { min = 0, max = 3, default = 0.8, doc = "Brightness from which light glows; linear, without a knee." },
    blur_iterations = fx.int { min = 0, max = 7, default = 5, doc = "Levels of blur; each doubles the reach. 0 and 1 add the thresholded light unblurred." },
    pattern = fx.enum { "plus", "box", default = "plus", doc = "Where the four samples lie: beside, above and below, or at the corners." },
    brightness = fx.enum { "max", "luma", default = "max", doc = "What the threshold compares: the largest channel, or 0.3 R + 0.59 G + 0.11 B." },
  },

  -- The weights of luma add up to 1 but for their rounding.
  idle = function(s, _, length_scale)
    return { brightest = s.threshold * (1 - (length_scale ~= 1 and 1e-5 or s.brightness == "max" and 0 or 1e-6)) }
  end,

  holds = {
    "black", "constant", "mirror", "turn_180", "monotone", "turn_90",
    continuous = function(s) return 1 + math.max(s.blur_iterations - 1, 1) end,
    error = { fp32 = 1e-5, fp16 = 2e-3, levels = "blur_iterations" },
  },
  build = function(g, s, source)
    local blur = s.pattern == "plus" and fx.filters.plus(1) or fx.filters.box(1)
    -- Down: the first level has the size of the picture; stop before a size of 0.
    local width, height = pyramids.delivered(g, source)
    local sizes = { { width, height } }
    while #sizes < s.blur_iterations and width > 1 and height > 1 do
      width, height = width // 2, height // 2
      sizes[#sizes + 1] = { width, height }
    end
    local start = g.length_scale < 1 and pyramids.start(sizes, source.width, source.height) or 1
    local image = source
    if g.length_scale ~= 1 then image = pyramids.resized(g, source, sizes[start][1], sizes[start][2], "scaled") end
    image = g:pass { shader = "box_bloom/threshold", source = image, threshold = s.threshold, luma = s.brightness == "luma", name = "threshold" }
    local light, levels = image, { [start] = image }
    for i = start + 1, #sizes do
      image = g:filter { source = image, size = sizes[i], filter = blur, name = ("down[%d]"):format(i - 1) }
      levels[i] = image
    end

    -- Up: each level adds the blurred coarser one, down to half the size of the picture.
    for i = #sizes - 1, math.max(start, 2), -1 do
      local up = g:filter { source = image, size = levels[i], filter = blur, name = ("up[%d]"):format(i - 1) }
      image = g:pass { shader = "bloom/add", source = up, high = levels[i], intensity = 1, name = ("combine[%d]"):format(i - 1) }
    end
    -- Levels that are finer than a preview look like it.
    if start > 2 then image = g:pass { shader = "bloom/add", source = light, high = image, intensity = start - 2, name = "finer" } end

    if image.width ~= source.width or image.height ~= source.height then
      image = g:filter { source = image, size = source, filter = fx.filters.bilinear(), name = "up" }
    end
    return g:pass { shader = "bloom/add", source = image, high = source, intensity = 1, name = "final" }
  end,
}
