// SPDX-License-Identifier: MIT
#include "image/time_code.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/parse_number.h"

namespace afterglow {
namespace {

/// A part of a time code: its bits, and what it may be.
struct Digits {
  int shift = 0;
  std::uint32_t mask = 0, most = 0;
};
constexpr std::array kParts{Digits{24, 0x3f, 23}, Digits{16, 0x7f, 59}, Digits{8, 0x7f, 59}, Digits{0, 0x3f, 39}};
constexpr std::uint32_t kDropFrame = 1 << 6;

}  // namespace

std::string time_code_text(std::uint32_t coded) {
  std::array<std::uint32_t, 4> values{};
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const std::uint32_t digits = coded >> kParts[i].shift & kParts[i].mask;
    values[i] = (digits >> 4) * 10 + (digits & 15);
    if ((digits & 15) > 9 || values[i] > kParts[i].most) return "";
  }
  return fmt::format("{:02}:{:02}:{:02}{}{:02}", values[0], values[1], values[2], (coded & kDropFrame) != 0 ? ';' : ':',
                     values[3]);
}

bool is_time_code(std::string_view text) {
  constexpr std::size_t kFrames = 9;
  if (text.size() != kFrames + 2) return false;
  const auto frames = parse_number<int>(text.substr(kFrames));
  return frames && *frames >= 0 && time_code_of(std::string(text.substr(0, kFrames)) + "00").has_value();
}

std::optional<std::uint32_t> time_code_of(std::string_view text) {
  constexpr std::size_t kLength = 11;
  if (text.size() != kLength || text[2] != ':' || text[5] != ':' || (text[8] != ':' && text[8] != ';'))
    return std::nullopt;
  std::uint32_t coded = text[8] == ';' ? kDropFrame : 0;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const auto number = parse_number<std::uint32_t>(text.substr(3 * i, 2));
    if (!number || *number > kParts[i].most) return std::nullopt;
    coded |= (*number / 10 << 4 | *number % 10) << kParts[i].shift;
  }
  return coded;
}

std::string time_code_after(std::string_view text, long long frames, Rational rate) {
  // Frames may have more than the 39 that time_code_of allows: 48 to 60 a second.
  constexpr std::size_t kLength = 11;
  if (text.size() != kLength || rate.numerator <= 0 || rate.denominator <= 0) return "";
  std::array<long long, 4> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = parse_number<int>(text.substr(3 * i, 2));
    if (!number || *number < 0) return "";
    parts[i] = *number;
  }
  const long long nominal = std::llround(static_cast<double>(rate.numerator) / rate.denominator);
  if (nominal < 1 || parts[0] > 23 || parts[1] > 59 || parts[2] > 59 || parts[3] >= nominal) return "";
  // Of 30 (60) numbers of a second the first 2 (4) of each minute are left out, but for each tenth minute.
  const bool drops = text[8] == ';';
  if (drops && nominal != 30 && nominal != 60) return "";
  const long long dropped = drops ? nominal / 15 : 0, minute = 60 * nominal - dropped, ten = 10 * minute + dropped;
  const long long minutes = parts[0] * 60 + parts[1];
  if (parts[3] < dropped && parts[2] == 0 && minutes % 10 != 0) return "";
  long long number = (minutes * 60 + parts[2]) * nominal + parts[3] - dropped * (minutes - minutes / 10) + frames;
  const long long day = 24 * 6 * ten;
  number = (number % day + day) % day;
  const long long in_ten = number % ten;
  number += dropped * 9 * (number / ten) + (in_ten >= dropped ? dropped * ((in_ten - dropped) / minute) : 0);
  const long long seconds = number / nominal;
  return fmt::format("{:02}:{:02}:{:02}{}{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60, drops ? ';' : ':',
                     number % nominal);
}

}  // namespace afterglow
