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

-- How many bytes follow the first one of a letter in UTF-8, and the bits that it has of the letter; nil: it is none.
local function begun(byte)
  if byte < 0x80 then return 0, byte end
  if byte >= 0xC2 and byte < 0xE0 then return 1, byte & 0x1F end
  if byte >= 0xE0 and byte < 0xF0 then return 2, byte & 0x0F end
  if byte >= 0xF0 and byte < 0xF5 then return 3, byte & 0x07 end
end

-- The code points of a text in UTF-8. Bytes that are none, and letters that are cut off, are squares.
local function codes_of(text)
  local codes, at = {}, 1
  while at <= #text do
    local follow, code = begun(text:byte(at))
    local last = at + (follow or 0)
    for i = at + 1, last do
      local byte = text:byte(i) or 0
      if byte & 0xC0 ~= 0x80 then
        code, last = nil, i - 1
        break
      end
      code = code << 6 | byte & 0x3F
    end
    code = code or kSquare
    -- Marks of decomposed letters go, and the first half of "\r\n".
    if code ~= 0x0D and (code < 0x300 or code > 0x36F) then codes[#codes + 1] = code end
    at = last + 1
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
