-- SPDX-License-Identifier: MIT
-- What configurations of OpenColorIO call linear Rec.709, the space that looks work in (docs/ocio.md); "" is that space, too.
return {
  [""] = true, ["Linear Rec.709 (sRGB)"] = true, ["lin_rec709_srgb"] = true, ["lin_rec709"] = true, ["Utility - Linear - sRGB"] = true,
  ["Linear Rec.709"] = true, ["lin_srgb"] = true, ["lin_709"] = true, ["Linear BT.709"] = true,
}
