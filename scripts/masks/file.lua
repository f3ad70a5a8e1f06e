-- SPDX-License-Identifier: MIT
-- A picture beside the preset.
local fx = require "afterglow"
local feather = require "lib.feather"

local channels = { r = 0, g = 1, b = 2, a = 3, luma = 4 }

return fx.effect {
  name = "file",
  doc = "A picture from a file, stretched over the whole picture.",
  settings = {
    file = fx.file { extensions = { "exr", "png", "tif", "tiff", "hdr", "jpg", "jpeg" }, doc = "The picture." },
    channel = fx.enum { "r", "g", "b", "a", "luma", default = "luma", doc = "What of it is the mask." },
    raw = fx.bool { default = false, doc = "Its numbers count as they are: a painted grey of 50 % is half. Else they are colours, and that is 0.21 in linear light." },
    feather = feather.setting,
  },
  active = function(s) return s.file ~= "", "no file is named", true end,
  build = function(g, s, source)
    local mask = g:pass { shader = "mask/file", size = source, picture = g:image { file = s.file, alpha = s.channel == "a", raw = s.raw }, channel = channels[s.channel] }
    return feather.of(g, mask, s.feather)
  end,
}
