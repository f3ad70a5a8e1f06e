-- SPDX-License-Identifier: MIT
-- FXAA: smooths jagged edges by what can be seen in the picture alone. Timothy Lottes' FXAA 3.11, in the form of Catlike Coding's
-- "Custom SRP 17: FXAA", with its settings. Luma (perceptual brightness) is √luminance.
local fx = require "afterglow"

return fx.effect {
  name = "fxaa",
  doc = "Fast approximate anti-aliasing: smooths jagged edges; after tone mapping.",
  at = "after_post_process", order = 110, space = "display",
  settings = {
    fixed_threshold = fx.float { min = 0.0312, max = 0.0833, default = 0.0833, doc = "Contrast of luma below which nothing is done." },
    relative_threshold = fx.float { min = 0.063, max = 0.333, default = 0.166, doc = "The same as a share of the brightest neighbour." },
    subpixel_blending = fx.float { min = 0, max = 1, default = 0.75, doc = "How much single pixels and thin lines are smoothed; softens the picture." },
    quality = fx.enum { "low", "medium", "high", default = "high", doc = "How far the ends of an edge are looked for: low 6.5 pixels, medium and high 18.5, high with finer steps." },
  },
  -- It decides by comparing; where two things are equally likely, rounding does.
  -- No bound on the error: where two edges are equally strong, rounding decides which one is followed.
  holds = { "black", "constant", "bounded" },
  build = function(g, s, source)
    if g.preview_scale <= 0.75 then
      g:skip("the preview's pixels are coarser than the steps of edges")
      return source
    end
    local luma = g:pass { shader = "fxaa/luma", source = source, channels = 1, name = "luma" }
    return g:pass { shader = "fxaa/smooth_edges", source = source, luma = luma, quality = ({ low = 0, medium = 1, high = 2 })[s.quality],
                    fixed_threshold = s.fixed_threshold, relative_threshold = s.relative_threshold, subpixel_blending = s.subpixel_blending }
  end,
}
