-- SPDX-License-Identifier: MIT
-- Burn-in: text over the picture, in a box: the number of a frame, a time code, the name of a shot. The box with its letters is a small image
-- of its own, made again when the text changes. Over transparent parts its letters are light alone, which EXR and videos show and PNG, TIFF and WebP
-- do not: put such pictures over a background first. Formulas: docs/math.md §55.
local fx = require "afterglow"
local letters = require "lib.letters"
local time_code = require "lib.time_code"

local kMost = 256  -- letters

local function is_word(text)
  for i = 1, #text do
    local byte = text:byte(i) | 0x20
    if byte < 97 or byte > 122 then return false end
  end
  return text ~= ""
end

-- The words in braces, filled in. Braces around anything but letters stay.
local function filled(g, text, start)
  local first, drops = time_code.parse(start, g.fps)
  if not first then
    error(('start: "%s" is no time code at %.6g frames a second, as "01:00:00:00" is; ";" is for 29.97 and 59.94'):format(start, g.fps), 0)
  end
  local words = {
    frame = function() return ("%04.0f"):format(math.floor(g.frame)) end,
    time = function() return ("%.3f"):format(g.time) end,
    timecode = function() return time_code.text(first + math.floor(g.time * g.fps + 0.5), g.fps, drops) end,
  }
  local out, from = "", 1
  while true do
    local open = text:find("{", from, true)
    local close = open and text:find("}", open, true)
    if not close then return out .. text:sub(from) end
    local name = text:sub(open + 1, close - 1)
    if not is_word(name) then
      out, from = out .. text:sub(from, open), open + 1
    elseif words[name] then
      out, from = out .. text:sub(from, open - 1) .. words[name](), close + 1
    else
      error(("text: {%s} is none of {frame}, {time}, {timecode}"):format(name), 0)
    end
  end
end

-- The cells row by row, four in a vector, each line moved by `align` of the room that it leaves.
local function packed(lines, columns, align)
  local cells = {}
  for row, line in ipairs(lines) do
    local before = math.floor((columns - #line) * align + 0.5)
    for i, cell in ipairs(line) do cells[(row - 1) * columns + before + i] = cell end
  end
  local vectors = {}
  for i = 1, kMost, 4 do vectors[#vectors + 1] = { cells[i] or 0, cells[i + 1] or 0, cells[i + 2] or 0, cells[i + 3] or 0 } end
  return vectors
end

-- The label's sides, in steps: text that grows with the frames does not want other images with each.
local function steps(length) return math.ceil(length / 32) * 32 end

return fx.effect {
  name = "burn_in",
  doc = "Text over the picture: the number of the frame, a time code, a name.",
  at = "after_post_process", order = 220, space = "display",
  settings = {
    text = fx.text { default = "{frame}", doc = "With \"\\n\" between lines; lines times the letters of the longest are 256 at most. {frame}, {time} and {timecode} are filled in: 0042, 1.750 (seconds), 00:00:01:18. Latin, Greek and Cyrillic; \"\": none." },
    start = fx.text { default = "00:00:00:00", doc = "{timecode} at time 0: of frame 0 of pictures, of the first frame of videos. \"01:00:00;00\" drops numbers, at 29.97 and 59.94 frames a second." },
    position = fx.vec2 { min = 0, max = 1, default = { 0.5, 1 }, doc = "Where the text is: {0, 0} in the upper left corner, {1, 1} in the lower right. Its lines are flush accordingly." },
    size = fx.float { min = 0.005, max = 1, default = 0.05, doc = "Height of a line, as a share of the picture's height. Less where the text would not fit." },
    margin = fx.float { min = 0, max = 0.5, default = 0.03, doc = "From the picture's border, as a share of its height." },
    color = fx.color { default = { 1, 1, 1 }, doc = "The letters; display-linear." },
    background = fx.color { default = { 0, 0, 0 }, doc = "The box and the outline; display-linear." },
    box = fx.float { min = 0, max = 1, default = 0.7, doc = "How opaque the box is. 0: none." },
    outline = fx.float { min = 0, max = 0.1, default = 0, doc = "Width of a line around the letters, as a share of a line's height. 0: none." },
  },
  active = function(s) return s.text ~= "", "text is empty" end,
  holds = {
    "monotone", continuous = 1,
    -- Beside a letter little of a bright colour is seen: as exact as its share.
    error = { fp32 = 2e-3, fp16 = 2e-2, up_to = 10, when = function(s)
      return math.max(s.color[1], s.color[2], s.color[3], s.background[1], s.background[2], s.background[3]) <= 10
    end },
  },
  build = function(g, s, source)
    local lines = letters.lines(filled(g, s.text, s.start))
    local columns = 1
    for _, line in ipairs(lines) do columns = math.max(columns, #line) end
    if columns * #lines > kMost then
      error(("text: %d lines of up to %d letters are %d; at most %d fit"):format(#lines, columns, columns * #lines, kMost), 0)
    end
    -- In heights of a line: letters are half as wide; a quarter of a line and a tenth are left around them.
    local across, down = 0.5 * columns + 0.5, #lines + 0.2
    local margin = { math.min(s.margin * source.height, 0.25 * source.width), math.min(s.margin, 0.25) * source.height }
    local room = { source.width - 2 * margin[1], source.height - 2 * margin[2] }
    local line = math.min(s.size * source.height, room[1] / across, room[2] / down)
    local box = { across * line, down * line }
    local corner = { margin[1] + s.position[1] * (room[1] - box[1]), margin[2] + s.position[2] * (room[2] - box[2]) }
    local whole = { math.floor(corner[1]), math.floor(corner[2]) }
    local origin = { corner[1] - whole[1], corner[2] - whole[2] }
    local label = g:pass {
      shader = "burn_in/letters", name = "letters", font = g:image { file = letters.picture, raw = true },
      size = { steps(origin[1] + box[1]), steps(origin[2] + box[2]) },
      letters = packed(lines, columns, s.position[1]), cells = { columns, #lines }, origin = origin, box = box, line = line,
      reads = math.min(math.max(math.ceil(48 / line), 1), 4),  -- small letters: as many as the font has texels
      ink = s.color, ground = s.background, opacity = s.box, outline = s.outline,
    }
    return g:pass { shader = "burn_in/over", source = source, label = label, corner = whole }
  end,
}
