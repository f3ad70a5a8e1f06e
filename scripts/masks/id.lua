-- SPDX-License-Identifier: MIT
-- Objects and materials by number.
local fx = require "afterglow"
local feather = require "lib.feather"

local kTent = { { -1, 0.25 }, { 0, 0.5 }, { 1, 0.25 } }

return fx.effect {
  name = "id",
  doc = "What has a number in a pass of numbers: an object or a material by its pass index, an object ID.",
  settings = {
    index = fx.int { min = 0, max = 16777215, default = 1, doc = "Which number: up to 16777215, floats hold no larger ones exactly. For several, add masks." },
    layer = fx.text { default = "IndexOB", doc = "The pass: IndexOB (objects) or IndexMA (materials) of Blender, whatever the renderer calls it." },
    antialias = fx.bool { default = false, doc = "Smooths the edges over 3 × 3 pixels; a pass of numbers has hard ones." },
    feather = feather.setting,
  },
  needs = function(s) return s.layer ~= "" and { "layer:" .. s.layer } or {} end,
  active = function(s) return s.layer ~= "", "no layer is named", true end,
  build = function(g, s, source)
    local mask = g:pass { shader = "mask/id", source = source, layer = g:input("layer:" .. s.layer), index = s.index }
    if s.antialias then
      mask = g:filter { source = mask, filter = { interpolation = "nearest", x = kTent, y = kTent }, channels = 1, name = "antialias" }
    end
    return feather.of(g, mask, s.feather)
  end,
}
