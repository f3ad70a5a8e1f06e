-- SPDX-License-Identifier: MIT
-- Anamorphic streaks: the horizontal flares of an anamorphic lens. A pyramid that is halved across alone; on the way up each level takes a
-- share of the coarser one (after K. Takahashi's Kino/Streak for Unity, whose settings and tint these are).
local fx = require "afterglow"
local glow = require "lib.glow"
local pyramids = require "lib.pyramid"

local kHalving = { x = { { -1.5, 1 / 8 }, { -0.5, 3 / 8 }, { 0.5, 3 / 8 }, { 1.5, 1 / 8 } } }

-- What light is multiplied by, at most.
local function gain(s) return s.intensity * math.max(s.tint[1], s.tint[2], s.tint[3]) end

return fx.effect {
  name = "anamorphic_streaks",
  doc = "Long horizontal flares from bright lights, as of an anamorphic lens.",
  at = "post_process", order = 110, space = "scene",
  settings = {
    threshold = fx.float { min = 0, max = 1e6, default = 2, doc = "Brightness (largest channel) from which light streaks; linear." },
    stretch = fx.float { min = 0, max = 1, default = 0.75, doc = "Length of the streaks: the share that each level takes from the coarser one." },
    intensity = fx.float { min = 0, max = 100, default = 0.4, doc = "Factor of the streaks. 0: none." },
    tint = fx.color { default = { 0.55, 0.55, 1 }, doc = "Colour of the streaks." },
  },
  active = function(s)
    if s.intensity <= 0 then return false, "intensity is 0" end
    return s.tint[1] > 0 or s.tint[2] > 0 or s.tint[3] > 0, "tint is black"
  end,

  holds = {
    "black", "constant", "mirror", "turn_180", "monotone",
    continuous = function(s) return 1 + gain(s) end,
    -- Half floats are rounded twice at each of up to eleven levels. What little exceeds a high threshold keeps the rounding of what it was.
    error = { fp32 = function(s) return 1e-5 * math.max(1, s.threshold * gain(s)) end, fp16 = function(s) return 3e-3 * math.max(1, s.threshold * gain(s)) end,
              when = function(s) return gain(s) <= 1e5 end },
  },
  build = function(g, s, source)
    local width, height = pyramids.delivered(g, source)
    width, height = math.max(width // 2, 1), math.max(height // 2, 1)
    local sizes = { { width, height } }
    while width >= 8 do
      width = width // 2
      sizes[#sizes + 1] = { width, height }
    end
    local start = 1
    if g.length_scale ~= 1 then
      height = math.min(height, source.height)
      for _, size in ipairs(sizes) do size[2] = height end
      if g.length_scale < 1 then start = pyramids.start(sizes, source.width, height) end
    end
    local image = glow.bright(g, source, sizes[start][1], height, s.threshold)
    local levels = { image }
    for i = start + 1, #sizes do
      image = g:filter { source = image, size = sizes[i], filter = kHalving, name = ("down[%d]"):format(#levels) }
      levels[#levels + 1] = image
    end
    for i = #levels - 1, 1, -1 do
      image = g:filter { source = image, size = levels[i], filter = fx.filters.bilinear(), name = ("up[%d]"):format(i) }
      image = g:pass { shader = "bloom/scatter", source = image, high = levels[i], amount = s.stretch, name = ("combine[%d]"):format(i) }
    end
    -- Levels that are finer than a preview look like it.
    if start > 1 then
      image = g:pass { shader = "bloom/scatter", source = image, high = levels[1], amount = s.stretch ^ (start - 1), name = "finer" }
    end
    image = g:filter { source = image, size = source, filter = fx.filters.bilinear(), name = "up" }
    local tint = {}
    for i = 1, 3 do tint[i] = math.min(s.tint[i] * s.intensity, 1e6) end
    return g:pass { shader = "anamorphic_streaks/add", source = image, high = source, tint = tint, name = "final" }
  end,
}
