-- SPDX-License-Identifier: MIT
-- Directional blur: a camera that moves while the shutter is open. n·m equally spaced reads on a line are m reads close together of an image
-- that has been blurred by n reads far apart, so that 32 reads twice do for a thousand pixels. n·m reads, each for one part of the line, and
-- at most a pixel apart: where their number is the length, they are a pixel apart and the line is even.
local fx = require "afterglow"

-- n reads on a line, `spacing` apart.
local function line(n, spacing, x, y)
  local taps = {}
  for i = 1, n do
    local at = (i - (n + 1) / 2) * spacing
    taps[i] = { at * x, at * y, 1 / n }
  end
  return { taps = taps }
end

-- Two counts whose product is at least `reads` and as near to it as it gets, without more reads than by its root.
local function factors(reads)
  local root = math.ceil(math.sqrt(reads))
  local n, m = root, root
  for near = root, 2 * root do
    local far = math.ceil(reads / near)
    if far + near <= 2 * root and far * near < n * m then n, m = far, near end
  end
  return n, m
end

return fx.effect {
  name = "directional_blur",
  doc = "Smears the picture along one direction, as a moving camera does.",
  at = "post_process", order = 84,
  settings = {
    distance = fx.float { min = 0, max = 1000, default = 24, unit = "px", doc = "Length of the smear. 0: none." },
    angle = fx.float { min = -180, max = 180, default = 0, unit = "degrees", doc = "Direction: 0 across, 90 up and down, 45 rising to the right." },
  },
  active = function(s) return s.distance > 0, "distance is 0" end,
  holds = { "black", "constant", "bounded", "monotone", "linear", "turn_180", continuous = 1, error = { fp32 = 5e-4, fp16 = 4e-3, up_to = 50 } },
  build = function(g, s, source)
    local radians = s.angle * math.pi / 180
    local x, y = math.cos(radians), -math.sin(radians)
    local n, m = factors(math.max(2, math.ceil(s.distance)))
    local spacing = s.distance / (n * m)
    local image = g:filter { source = source, filter = line(n, m * spacing, x, y), name = "far" }
    image = g:filter { source = image, filter = line(m, spacing, x, y), name = "near" }
    return g:pass { shader = "bloom/scatter", source = image, high = source, amount = 1, name = "final" }  -- alpha of the picture
  end,
}
