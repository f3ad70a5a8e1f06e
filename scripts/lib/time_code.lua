-- SPDX-License-Identifier: MIT
-- Time codes (SMPTE ST 12-1): hours, minutes, seconds and frames. Rates that are not whole count by the nearest whole one. ";" before the frames drops
-- numbers at 29.97 and 59.94 frames a second, so that the code keeps with the clock: 2 or 4 at each minute but every tenth.
local time_code = {}

-- Frames that a second counts, and numbers that a minute can drop; 0 at rates that drop none.
local function counted(fps)
  local rate = math.max(math.floor(fps + 0.5), 1)
  local slowed = (rate == 30 or rate == 60) and math.abs(fps * 1.001 - rate) < 0.005
  return rate, slowed and rate // 15 or 0
end

---"01:00:00:00" as a number of frames, and whether numbers are dropped. nil: it is no time code at this rate.
function time_code.parse(text, fps)
  local rate, drop = counted(fps)
  local mark = text:sub(9, 9)
  if #text ~= 11 or text:sub(3, 3) ~= ":" or text:sub(6, 6) ~= ":" or (mark ~= ":" and mark ~= ";") then return nil end
  local part = {}
  for i, from in ipairs { 1, 4, 7, 10 } do
    local a, b = text:byte(from, from + 1)
    if a < 48 or a > 57 or b < 48 or b > 57 then return nil end
    part[i] = 10 * (a - 48) + b - 48
  end
  if part[1] > 23 or part[2] > 59 or part[3] > 59 or part[4] >= rate then return nil end
  if mark == ":" then drop = 0 elseif drop == 0 then return nil end
  if part[3] == 0 and part[2] % 10 ~= 0 and part[4] < drop then return nil end  -- a number that is dropped
  local minutes = part[1] * 60 + part[2]
  return (minutes * 60 + part[3]) * rate + part[4] - drop * (minutes - minutes // 10), mark == ";"
end

---The time code of a number of frames. Hours begin again after 24.
function time_code.text(frames, fps, drops)
  local rate, drop = counted(fps)
  if not drops then drop = 0 end
  local minute, ten = rate * 60 - drop, rate * 600 - 9 * drop
  frames = frames % (ten * 144)
  local within = frames % ten
  frames = frames + 9 * drop * (frames // ten) + (within >= drop and drop * ((within - drop) // minute) or 0)
  local seconds = frames // rate
  return ("%02d:%02d:%02d%s%02d"):format(seconds // 3600 % 24, seconds // 60 % 60, seconds % 60, drop > 0 and ";" or ":", frames % rate)
end

return time_code
