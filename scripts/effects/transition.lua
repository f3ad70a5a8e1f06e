-- SPDX-License-Identifier: MIT
-- Transition: from this picture to another, by `progress`. The other is a file (scaled to cover the picture), a layer of the picture's own file, or a plain colour. `progress` moves
-- with the frames, as in progress = fx.curve { { 48, 0 }, { 60, 1 } }, or is an argument of the look (docs/composition.md). Another shot:
-- to = function(t) return string.format("next.%04d.exr", t.frame - 40) end, beside the preset; pictures of frames that are done make room for those that come: what one frame reads may be 512 MiB. Formulas: docs/math.md §34.
local fx = require "afterglow"

local kKinds = { dissolve = 0, fade = 1, wipe = 2, iris = 3, clock = 4, blinds = 5, scatter = 6, push = 7 }

return fx.effect {
  name = "transition",
  doc = "Goes over to another picture: dissolve, fade, wipe, iris, clock, blinds, scatter, push.",
  at = "after_post_process", order = 180, space = "display",
  settings = {
    progress = fx.float { min = 0, max = 1, default = 0, doc = "0: this picture. 1: the other." },
    kind = fx.enum { "dissolve", "fade", "wipe", "iris", "clock", "blinds", "scatter", "push", default = "dissolve",
      doc = "dissolve: both at once. fade: through `color`. wipe: a line moves over. iris: a circle opens. clock: a hand goes round. blinds: strips. scatter: grains. push: one moves the other out." },
    to = fx.file { extensions = { "png", "jpg", "jpeg", "exr", "tif", "tiff", "hdr" }, doc = "The other picture, or one for each frame by a function; none: `color`." },
    layer = fx.text { default = "", doc = "In place of `to`: a layer of the picture's own file, by name." },
    color = fx.color { default = { 0, 0, 0 }, doc = "The other picture where none is given, and what `fade` goes through." },
    angle = fx.float { min = -360, max = 360, default = 0, unit = "degrees", doc = "wipe, push, blinds: where it moves to; 0 right, 90 up (push: the nearest of the four sides). clock: where the hand starts." },
    softness = fx.float { min = 0, max = 1, default = 0.05, doc = "wipe, iris, clock, blinds, scatter: width of the edge, as a share of the whole way. A pixel at least, but for scatter." },
    center = fx.vec2 { min = 0, max = 1, default = { 0.5, 0.5 }, doc = "iris, clock: the point it is about; {0, 0} is the upper left corner, {1, 1} the lower right." },
    count = fx.int { min = 1, max = 256, default = 12, doc = "blinds: how many strips." },
    grain = fx.float { min = 1, max = 512, default = 24, unit = "px", doc = "scatter: size of the grains." },
    seed = fx.int { min = 0, default = 0, doc = "scatter: another number, another order." },
  },
  optional = function(s) return s.layer ~= "" and { "layer:" .. s.layer } or {} end,
  active = function(s) return s.progress > 0, "progress is 0" end,
  holds = {
    black = { when = function(s) return s.to == "" and s.layer == "" and s.color[1] == 0 and s.color[2] == 0 and s.color[3] == 0 end },
    "monotone", continuous = 1,
    -- Where an edge only begins, rounding decides whether a bright colour is seen at all.
    error = { fp32 = function(s) return s.kind == "blinds" and 1e-2 or 1e-3 end, fp16 = function(s) return s.kind == "blinds" and 1e-2 or 2e-3 end, up_to = 10, when = function(s)
      return s.to == "" and s.layer == "" and s.kind ~= "scatter" and math.max(table.unpack(s.color)) <= 1e4
    end },
  },
  build = function(g, s, source)
    local other
    if s.layer ~= "" then other = g:input("layer:" .. s.layer) end
    if not other and s.to ~= "" then
      other = g:pass { shader = "transition/cover", source = g:image { file = s.to }, size = source, name = "cover" }
    end
    local turn = math.rad(s.angle)
    local aspect = source.width / source.height
    local across, down = math.cos(turn), -math.sin(turn)
    local hand = 2 * math.pi * s.progress - turn
    -- The edge's whole way: from where it just touches the picture to where it has left it.
    local span = math.abs(across) * aspect + math.abs(down)
    local corner_x, corner_y = math.max(s.center[1], 1 - s.center[1]) * aspect, math.max(s.center[2], 1 - s.center[2])
    local widest = math.max(math.sqrt(corner_x ^ 2 + corner_y ^ 2), 1e-6)
    -- A pixel, as a share of the way: no edge is narrower. The clock's depends on the distance from the middle.
    local ways = { wipe = span, iris = widest, blinds = span / s.count }
    local pixel = ways[s.kind] and math.min(1 / (source.height * ways[s.kind]), 1) or 1e-4
    local size = math.max(1, s.grain)
    local coarse = math.floor(size * 64) / 64
    return g:pass {
      shader = "transition/cut", source = source, other = other or source, size = source, name = "cut", kind = kKinds[s.kind], has_other = other ~= nil,
      progress = s.progress, plain = s.color, direction = { across, down }, span = span, soft = math.max(s.softness, pixel), pixel = pixel, center = s.center, aspect = aspect,
      widest = widest, hand = { math.cos(hand), math.sin(hand) }, count = s.count, grain = { coarse, size - coarse }, seed = s.seed,
    }
  end,
}
