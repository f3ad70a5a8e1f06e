-- SPDX-License-Identifier: MIT
-- Illustration and previsualisation: dark lines around objects (depth) and along their creases (normals), colours kept flat by Reinhard's
-- curve. Needs a picture with depth and normals, such as Blender's multilayer EXR; without them the lines are skipped with a warning.
local fx = require "afterglow"

return fx.stack {
  name = "Ink outline",
  requires = "0.2",
  reference_height = 1080,
  fx.outline { source = "mixed", combine = "max", width = 1.6, fade_distance = 40, depth_scale = 4, normal_scale = 0.6, contrast = 3, smoothness = 1,
               color = { 0.01, 0.008, 0.02 }, mask = fx.mask.luma { from = 3, softness = 3, invert = true } },
  fx.color_adjustments { post_exposure = 1.15, contrast = 16 },
  -- Not on bright light: a channel below 0 stays 0 under Reinhard's curve, and white neon would turn yellow, pink neon magenta.
  fx.color_adjustments { order = 191, saturation = 14, mask = fx.mask.luma { from = 1.5, softness = 1.5, invert = true } },
  fx.tone_mapping { mode = "reinhard" },
  fx.smaa {},
}
