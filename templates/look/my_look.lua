-- A look to start from: a lens that glows, a grade, a curve to the display, a little grain.
--
--   afterglow play my_look.lua render.exr              the picture, while this file is edited
--   afterglow run my_look.lua render.exr -o out.png    the finished picture
--   afterglow check my_look.lua                        all settings, and what is wrong
--   afterglow effects, afterglow effects bloom         what else there is, and what each setting does
local fx = require "afterglow"

return fx.stack {
  name = "my_look",
  reference_height = 1080,  -- settings in px are those of a picture of 1080 lines: the same look at every size

  -- Scene light: as bright as in the scene, without an upper end.
  fx.bloom { mode = "scattering", threshold = 1, intensity = 0.15, scatter = 0.7, edges = "mirror", fade_fireflies = true },
  fx.vignette { intensity = 0.25 },
  fx.white_balance { temperature = 5 },
  fx.color_adjustments { post_exposure = 0, contrast = 5, saturation = 5 },

  -- The curve to what a display shows.
  fx.tone_mapping { mode = "agx" },

  -- Behind it: light of the display.
  fx.film_grain { intensity = 0.15 },
}
