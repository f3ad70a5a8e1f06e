-- SPDX-License-Identifier: MIT
-- SMAA 1x: enhanced subpixel morphological anti-aliasing (J. Jimenez, J. Echevarria, T. Sousa, D. Gutierrez, Eurographics 2012). Edges of luma with adaptation to local
-- contrast; each edge is followed to its two ends; what crosses it there says how the line runs, and how much of each pixel lies beyond it. These areas are computed
-- for any length where the original reads a texture. Corners are kept sharp as there; the search for diagonals is left out.
local fx = require "afterglow"

return fx.effect {
  name = "smaa",
  doc = "Morphological anti-aliasing: smooth edges without blur; after tone mapping.",
  at = "after_post_process", order = 105, space = "display",
  settings = {
    threshold = fx.float { min = 0.01, max = 0.5, default = 0.08, doc = "Contrast of luma from which there is an edge." },
    search = fx.int { min = 1, max = 112, default = 32, unit = "px", doc = "How far the ends of an edge are looked for, each way." },
    corner_rounding = fx.float { min = 0, max = 100, default = 25, unit = "%", doc = "How much corners are rounded: 0 keeps them sharp." },
  },
  -- No bound on the error: where two edges are equally strong, rounding decides which one is there.
  holds = { "black", "constant", "bounded" },
  build = function(g, s, source)
    if g.preview_scale <= 0.75 then
      g:skip("the preview's pixels are coarser than the steps of edges")
      return source
    end
    local luma = g:pass { shader = "fxaa/luma", source = source, channels = 1, name = "luma" }
    local edges = g:pass { shader = "smaa/edges", source = luma, threshold = s.threshold, reach = 2, channels = 2, name = "edges" }
    local search = math.max(1, math.floor(s.search + 0.5))
    local weights = g:pass { shader = "smaa/weights", source = edges, search = search, rounding = 1 - s.corner_rounding / 100, reach = search + 3, name = "weights" }
    return g:pass { shader = "smaa/blend", source = source, weights = weights, reach = 1, name = "blend" }
  end,
}
