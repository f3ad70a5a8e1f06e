-- SPDX-License-Identifier: MIT
-- Text as cells of `assets/fonts/mono.exr`, which tools/font_atlas.py makes: letters of one width, 32 in a row of the picture.
local letters = {}

-- The first and last code point of each run, in the order of the cells.
local kRanges = {
  { 0x20, 0x7E }, { 0xA0, 0x17F }, { 0x384, 0x3CE }, { 0x400, 0x45F }, { 0x2010, 0x2015 }, { 0x2018, 0x201E }, { 0x2020, 0x2022 },
  { 0x2026, 0x2026 }, { 0x20AC, 0x20AC }, { 0x2122, 0x2122 }, { 0x2190, 0x2193 }, { 0x25A1, 0x25A1 }, { 0x25CF, 0x25CF },
}
local kSquare = 0x25A1  -- stands for letters that the picture lacks

letters.picture = "fonts/mono.exr"

local function find(code)
  local before = 0
  for _, range in ipairs(kRanges) do
    if code >= range[1] and code <= range[2] then return before + code - range[1] end
    before = before + range[2] - range[1] + 1
  end
end

-- The code points of a text in UTF-8. A byte that begins none is a square.
local function codes_of(text)
  local codes, left = {}, 0
  for i = 1, #text do
    local byte = text:byte(i)
    if left > 0 and byte & 0xC0 == 0x80 then
      codes[#codes], left = codes[#codes] << 6 | byte & 0x3F, left - 1
    else
      left = byte < 0xC0 and 0 or byte < 0xE0 and 1 or byte < 0xF0 and 2 or 3
      codes[#codes + 1] = byte < 0x80 and byte or byte & 0x3F >> left
    end
  end
  return codes
end

---Lines of a text, each a list of numbers of cells; "\n" ends a line. Letters that there are not are squares.
function letters.lines(text)
  local lines = { {} }
  for _, code in ipairs(codes_of(text)) do
    local line = lines[#lines]
    if code == 0x0A then
      lines[#lines + 1] = {}
    else
      line[#line + 1] = find(code < 0x20 and 0x20 or code) or find(kSquare)
    end
  end
  return lines
end

return letters
