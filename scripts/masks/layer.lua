-- SPDX-License-Identifier: MIT
-- A layer that the picture brings along.
local fx = require "afterglow"
local feather = require "lib.feather"

local channels = { r = 0, g = 1, b = 2, a = 3, luma = 4 }

return fx.effect {
  name = "layer",
  doc = "A channel of a layer of the picture: a matte, an object's alpha, an albedo.",
  settings = {
    layer = fx.text { doc = "The layer; the end of its name is enough where no other ends so." },
    channel = fx.enum { "r", "g", "b", "a", "luma", default = "r", doc = "Which of its channels. Of a layer of one channel: r." },
    feather = feather.setting,
  },
  needs = function(s) return s.layer ~= "" and { "layer:" .. s.layer } or {} end,
  active = function(s) return s.layer ~= "", "no layer is named", true end,
  build = function(g, s, source)
    local mask = g:pass { shader = "mask/channel", source = source, layer = g:input("layer:" .. s.layer), channel = channels[s.channel] }
    return feather.of(g, mask, s.feather)
  end,
}
