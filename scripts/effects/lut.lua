-- SPDX-License-Identifier: MIT
-- LUT: colours by a look-up table in a file. OpenColorIO reads the file (.cube of Adobe and Resolve, .3dl, .csp, .spi1d, .spi3d, .clf, …); its steps
-- are done in order: matrices and ranges (the domain of a .cube), curves linearly between their entries, cubes tetrahedrally between the
-- four nearest (a .clf may ask for all eight). Tables know colours from 0 to 1 alone: what is outside of a table's domain gets the colour of its edge.
-- `input` says how colours are encoded before the look-up, `output` what the table gives; tables for finished pictures want "srgb" (the
-- default) or a power, those for scenes the logarithm of a camera or of ACES, with its primaries: math.md §24 has curves and sources. Alpha stays.
local fx = require "afterglow"

-- Numbers: shaders/lib/encoding.glsl.
local encodings = { linear = 0, srgb = 1, acescct = 2, logc3 = 3, logc4 = 4, slog3 = 5, pq = 6, hlg = 7, gamma22 = 8, gamma24 = 9, cineon = 10, rec709 = 11,
  apple_log = 12, bmd_film5 = 13, clog2 = 14, clog3 = 15, davinci_intermediate = 16, log3g10 = 17, slog3_sgamut3 = 18, vlog = 19 }
local of_displays = { srgb = true, gamma22 = true, gamma24 = true, rec709 = true }

return fx.effect {
  name = "lut",
  doc = "Colours by a look-up table from a file (.cube and others).",
  at = "after_post_process", order = 100, alpha = "straight",
  space = function(s)
    local output = s.output == "same" and s.input or s.output
    if of_displays[s.input] then return "display" end
    return { needs = "scene", makes = of_displays[output] and "display" or nil }
  end,
  settings = {
    file = fx.file {
      extensions = { "cube", "3dl", "csp", "spi1d", "spi3d", "clf", "cub", "lut", "hdl", "itx", "m3d", "mga", "vf", "cc", "cdl" },
      doc = "The table: beside the preset or on the search path. None: no effect.",
    },
    intensity = fx.float { min = 0, max = 1, default = 1, doc = "How much of the table's colours: 0 none, 1 they alone." },
    input = fx.enum {
      "linear", "srgb", "acescct", "logc3", "logc4", "slog3", "pq", "hlg", "gamma22", "gamma24", "cineon", "rec709",
      "apple_log", "bmd_film5", "clog2", "clog3", "davinci_intermediate", "log3g10", "slog3_sgamut3", "vlog",
      default = "srgb", doc = "How the table wants its colours: scene-linear Rec.709, sRGB, ACEScct, ARRI LogC3 (EI 800) or LogC4, Sony S-Log3, PQ, HLG, a power, Cineon printing density, the camera curve of Rec.709, Apple Log, Blackmagic Film (generation 5), Canon Log 2 or 3, DaVinci Intermediate, RED Log3G10, S-Log3 of S-Gamut3, V-Log.",
    },
    output = fx.enum {
      "same", "linear", "srgb", "acescct", "logc3", "logc4", "slog3", "pq", "hlg", "gamma22", "gamma24", "cineon", "rec709",
      "apple_log", "bmd_film5", "clog2", "clog3", "davinci_intermediate", "log3g10", "slog3_sgamut3", "vlog",
      default = "same", doc = "How the colours are encoded that it gives; same: as its input.",
    },
  },
  active = function(s)
    if s.file == "" then return false, "file is not given", true end
    return s.intensity > 0, "intensity is 0"
  end,
  holds = { "constant", "mirror", "turn_180", "turn_90", shift = 1 },
  build = function(g, s, source)
    local lookup = g:lookup { file = s.file }
    local output = s.output == "same" and s.input or s.output
    local pass = {
      shader = "lut/apply", source = source, table = lookup.table, intensity = s.intensity,
      before = encodings[s.input], behind = encodings[output], unit = lookup.unit,
    }
    for i, step in ipairs(lookup.steps) do
      pass["kind" .. i], pass["row" .. i], pass["size" .. i] = step.kind, step.row, step.size
    end
    return g:pass(pass)
  end,
}
