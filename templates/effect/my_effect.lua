-- An example: afterglow run my_effect.lua render.exr -o out.png
local fx = require "afterglow"

return fx.stack {
  name = "my_effect",
  fx.my_effect { strength = 0.5 },
}
