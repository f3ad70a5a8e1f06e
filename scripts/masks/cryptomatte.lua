-- SPDX-License-Identifier: MIT
-- Objects and materials by name.
local fx = require "afterglow"
local feather = require "lib.feather"

return fx.effect {
  name = "cryptomatte",
  doc = "Objects, materials or assets by name, with their soft edges, from the picture's cryptomatte.",
  settings = {
    names = fx.text { doc = "Up to 8 names, with commas between them; a name that has commas itself stands in quotation marks." },
    layer = fx.text { default = "CryptoObject", doc = "Of which cryptomatte: CryptoObject, CryptoMaterial, CryptoAsset of Blender." },
    feather = feather.setting,
  },
  needs = function(s) return { "layer:" .. s.layer .. "00" } end,
  optional = function(s) return { "layer:" .. s.layer .. "01", "layer:" .. s.layer .. "02" } end,
  active = function(s) return s.names ~= "", "no object is named", true end,
  build = function(g, s, source)
    local ids = g:cryptomatte { layer = s.layer, names = s.names }
    if #ids == 0 then
      g:skip("the picture has no object of these names")
      return source
    end
    local a, b = {}, {}
    for i = 1, 4 do a[i], b[i] = ids[i] or ids[1], ids[i + 4] or ids[1] end
    local mask
    for _, ranks in ipairs { "00", "01", "02" } do  -- two objects a pixel each
      local image = g:input("layer:" .. s.layer .. ranks)
      if image then
        mask = g:pass { shader = "mask/cryptomatte", source = source, ranks = image, before = mask or source, first = mask == nil, ids_a = a, ids_b = b }
      end
    end
    return feather.of(g, mask, s.feather)
  end,
}
