-- SPDX-License-Identifier: MIT
-- Edge detection on perceived brightness, by the gradient operators of Sobel, Scharr and Roberts. Each is scaled so that a straight step
-- from black to white is 1. For lines of objects instead of brightness see `outline`.
local fx = require "afterglow"

-- Lines are `intensity` times as sensitive as gradients are, and the ink may be much brighter than the picture.
local function rounding(s)
  return 1e-5 + 3e-5 * s.intensity * math.max(1, s.color[1], s.color[2], s.color[3], s.background[1], s.background[2], s.background[3])
end

return fx.effect {
  name = "edge_detection",
  doc = "Draws lines where brightness changes: Sobel, Scharr or Roberts. All that is brighter than display white counts as white.",
  at = "after_post_process", order = 105, detail = true, space = "display",
  settings = {
    operator = fx.enum { "sobel", "scharr", "roberts", default = "sobel",
      doc = "sobel: 3x3, the usual one. scharr: 3x3, treats all directions alike. roberts: 2x2, thin lines." },
    intensity = fx.float { min = 0, max = 100, default = 2, doc = "Factor of the gradient. 0: no lines." },
    threshold = fx.float { min = 0, max = 1, default = 0.05, doc = "Gradients up to this draw nothing." },
    color = fx.color { default = { 0, 0, 0 }, doc = "Colour of the lines. They end where the picture's alpha is 0." },
    background = fx.color { default = { 1, 1, 1 }, doc = "Colour between the lines." },
    background_opacity = fx.float { min = 0, max = 1, default = 0, doc = "0: lines over the picture. 1: lines over the background alone." },
  },
  active = function(s) return s.intensity > 0 or s.background_opacity > 0, "intensity and background_opacity are 0" end,
  holds = {
    "constant",
    mirror = { within = 1e-6, when = function(s) return s.operator ~= "roberts" end },
    -- Where the ink covers a bright picture nearly whole, what is left of it is rounded as the bright picture is.
    error = { fp32 = function(s) return 4e-4 + 2 * rounding(s) end, fp16 = function(s) return 2e-3 + 500 * rounding(s) end, up_to = 50 },
  },
  build = function(g, s, source)
    -- A preview's pixels show so much less of a line; larger pictures have broader ones.
    local finer, apart = math.min(1, g.length_scale), math.max(1, math.floor(g.length_scale + 0.5))
    local tones = source
    if apart > 1 then  -- no pixel between them is left out
      local mean = {}
      for i = 1, apart do mean[i] = { i - (apart + 1) / 2, 1 / apart } end
      tones = g:filter { source = source, filter = { x = mean, y = mean }, name = "mean" }
    end
    return g:pass { shader = "edge_detection/lines", source = source, tones = tones, operator = ({ sobel = 0, scharr = 1, roberts = 2 })[s.operator],
                    intensity = s.intensity, finer = finer, apart = apart, reach = apart, threshold = s.threshold, ink = s.color, paper = s.background, opacity = s.background_opacity }
  end,
}
