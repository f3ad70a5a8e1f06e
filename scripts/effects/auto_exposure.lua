-- SPDX-License-Identifier: MIT
-- Auto exposure: brings every picture to middle grey, and follows changes over time as an eye or a camera does. A histogram of log2 luminance
-- with its dark and bright ends left out, as in Unity (HDRP) and Unreal; adaptation as in Unreal: even in stops while far off, exponential near
-- the end, and the same whatever the frame rate. The first frame of a sequence is exposed at once.
local fx = require "afterglow"

local kBins = 64         -- two of them a texel
local kNear = 1.5        -- stops from which adaptation slows down
local kForgotten = 0.01  -- stops: what is left of an earlier difference of four stops after the pre-roll
local kLongest = 60      -- seconds of pre-roll at most
local kMost = 10000      -- frames of it

-- Frames until a start that was four stops off makes no more difference than kForgotten.
local function pre_roll(g, s)
  local speed = math.min(s.speed_up, s.speed_down)
  local seconds = ((4 - kNear) + kNear * math.log(kNear / kForgotten)) / speed
  return math.min(math.ceil(math.min(seconds, kLongest) / g.frame_time), kMost)
end

return fx.effect {
  name = "auto_exposure",
  doc = "Exposes for middle grey by a histogram of the picture, and adapts to changes over time. Where nothing is drawn (alpha 0) nothing is metered.",
  at = "post_process", order = 50, space = "scene",
  settings = {
    compensation = fx.float { min = -16, max = 16, default = 0, unit = "EV", doc = "Brighter or darker than middle grey, in stops." },
    min_ev = fx.float { min = -16, max = 16, default = -6, unit = "EV",
      doc = "Scenes darker than this are not brightened further. 0: an average of middle grey (0.18)." },
    max_ev = fx.float { min = -16, max = 16, default = 6, unit = "EV", doc = "Scenes brighter than this are not darkened further." },
    low_percentile = fx.float { min = 0, max = 99, default = 40, unit = "%", doc = "This share of the picture, its darkest part, does not count." },
    high_percentile = fx.float { min = 1, max = 100, default = 90, unit = "%", doc = "What is brighter than this share of the picture does not count." },
    metering = fx.enum { "average", "center", default = "average", doc = "average: the whole picture alike. center: its middle counts most." },
    speed_up = fx.float { min = 0.01, max = 1000, default = 4, unit = "EV/s", doc = "How fast the exposure follows when the scene gets brighter." },
    speed_down = fx.float { min = 0.01, max = 1000, default = 2, unit = "EV/s", doc = "How fast it follows when the scene gets darker." },
  },
  holds = { "black", "constant" },
  build = function(g, s, source)
    if s.high_percentile <= s.low_percentile then error("high_percentile must be above low_percentile", 0) end
    if s.max_ev < s.min_ev then error("max_ev must not be below min_ev", 0) end
    local grid = { math.min(source.width, 128), math.min(source.height, 72) }
    local meter = g:pass { shader = "auto_exposure/meter", compute = "auto_exposure/meter_group", source = source, size = grid, center = s.metering == "center" }
    local rows = g:pass { shader = "auto_exposure/count", compute = "auto_exposure/count_group", grid = meter, size = { kBins // 2, grid[2] } }
    local wanted = g:pass { shader = "auto_exposure/wanted", compute = "auto_exposure/wanted_group", rows = rows, size = { 1, 1 }, limits = { s.min_ev, s.max_ev },
                            percentiles = { s.low_percentile / 100, s.high_percentile / 100 } }
    local before = g:history { name = "before", first = wanted, pre_roll = pre_roll(g, s) }
    local adapted = g:pass { shader = "auto_exposure/adapt", source = wanted, before = before, seconds = g.frame_time,
                             speeds = { s.speed_up, s.speed_down } }
    g:keep(before, adapted)
    return g:pass { shader = "auto_exposure/expose", source = source, adapted = adapted, compensation = s.compensation }
  end,
}
