-- SPDX-License-Identifier: MIT
-- CRT: a picture tube. The picture is sampled to so many scan lines; a beam with a Gaussian spot draws each of them, wider where it is brighter; stripes of red, green and blue phosphor show
-- it; glass bends and rounds it, and light spreads a little in it. After T. Lottes' CRT shader (public domain, 2014) and CRT-Royale's beam model; beams and stripes are
-- normalised, so that the mean light stays and white stays white. Stripes are integrated over each pixel; those and lines that pixels cannot show fade, so that no moiré appears at any size.
local fx = require "afterglow"
local glow = require "lib.glow"
local pyramids = require "lib.pyramid"

-- Places on the tube are rounded: the more, the larger the picture.
local function stretch(source)
  return math.max(1, source.width / 512, source.height / 512, source.width / source.height / 32)
end

return fx.effect {
  name = "crt",
  doc = "A picture tube: scan lines, phosphor stripes, curved glass.",
  at = "after_post_process", order = 150, space = "display",
  settings = {
    lines = fx.int { min = 16, max = 4320, default = 270, doc = "Scan lines of the tube. Below three pixels of the picture each they fade; of two pixels none is seen." },
    softness = fx.float { min = 0.2, max = 4, default = 0.45, unit = "lines", doc = "Width of the beam's spot along a line." },
    scan_lines = fx.float { min = 0, max = 1, default = 0.85, doc = "How dark it is between lines. 0: not." },
    phosphor = fx.float { min = 0, max = 1, default = 0.35, doc = "How much the stripes of phosphor show. 0: not." },
    phosphor_size = fx.float { min = 1, max = 64, default = 3, unit = "px", doc = "Width of three stripes, red, green and blue. Below 3 pixels of the result they fade, at 2 there are none." },
    curvature = fx.float { min = 0, max = 1, default = 0.3, doc = "How round the glass is. 0: flat." },
    corner = fx.float { min = 0, max = 0.5, default = 0.04, doc = "Radius of the picture's corners, as a share of its height." },
    vignette = fx.float { min = 0, max = 1, default = 0.3, doc = "Light lost in the corners." },
    glow = fx.float { min = 0, max = 1, default = 0.12, doc = "Share of the light that spreads in the glass." },
    convergence = fx.float { min = 0, max = 4, default = 0.25, unit = "lines", doc = "How far red and blue land beside green." },
    brightness = fx.float { min = 0, max = 4, default = 1.1, doc = "Factor of the light." },
    intensity = fx.float { min = 0, max = 1, default = 1, doc = "How much of the tube is seen. 0: the picture as it was." },
  },
  active = function(s) return s.intensity > 0, "intensity is 0" end,
  holds = { "black", error = { fp32 = function(_, source) return 1.5e-3 * stretch(source) end, fp16 = function(_, source) return 4e-3 * stretch(source) end } },
  build = function(g, s, source)
    local down = math.min(s.lines, source.height)
    local across = math.max(1, math.min(source.width, math.floor(source.width * down / source.height + 0.5)))
    local signal = pyramids.resized(g, source, across, down, "signal")
    local spread = source
    if s.glow > 0 then
      spread = glow.of(g, signal, 1, glow.fog(signal, 1, 0.06 * down), function(width, height) return pyramids.resized(g, signal, width, height, "half") end)
    end
    local triad = math.max(s.phosphor_size, 1e-3)
    local texels = math.max(2, math.ceil(2.5 * s.softness))
    -- Stripes and lines of less than three pixels fade; of two they would beat with the pixels.
    local lines_shown = math.max(0, math.min(source.height / down - 2, 1))
    local stripes_shown = math.max(0, math.min(triad - 2, 1))
    return g:pass {
      shader = "crt/tube", source = signal, size = source, picture = source, spread = s.glow > 0 and spread or signal, name = "tube",
      texels = texels, soft = s.softness, cut = math.exp(-0.5 * ((texels + 0.5) / s.softness) ^ 2), dark = s.scan_lines * lines_shown, mask = s.phosphor * stripes_shown, triad = triad, bend = 0.25 * s.curvature,
      corner = math.max(s.corner, 1e-4), edge = 1.5 / source.height, falloff = s.vignette, glow = s.glow, apart = s.convergence, brightness = s.brightness, intensity = s.intensity,
    }
  end,
}
