// SPDX-License-Identifier: MIT
#include "image/kept_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parse_number.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::array<std::string_view, 9> kNumbers{"ExposureTime",         "FNumber",
                                                   "Exif:ISOSpeedRatings", "Exif:PhotographicSensitivity",
                                                   "Exif:FocalLength",     "Exif:FocalLengthIn35mmFilm",
                                                   "Exif:SubjectDistance", "GPS:Altitude",
                                                   "FramesPerSecond"};

/// Those of them that are whole numbers in Exif; the others are fractions, also where they have nothing behind the
/// point (f/8).
constexpr std::array<std::string_view, 3> kWholeNumbers{"Exif:ISOSpeedRatings", "Exif:PhotographicSensitivity",
                                                        "Exif:FocalLengthIn35mmFilm"};

std::optional<Rational> fraction(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto above = parse_number<int>(text.substr(0, slash)), below = parse_number<int>(text.substr(slash + 1));
  if (!above || !below || *below <= 0) return std::nullopt;
  return Rational{*above, *below};
}

}  // namespace

std::optional<Rational> rate_of(const MetadataValue& value) {
  constexpr double kLeast = 0.001, kMost = 10'000;
  const MetadataValue* from = &value;
  std::optional<MetadataValue> read;
  if (const auto* text = std::get_if<std::string>(&value)) {
    read = number_of_text("", *text);
    if (!read) return std::nullopt;
    from = &*read;
  }
  const double rate = metadata_number(*from, 0);
  if (!(rate >= kLeast && rate <= kMost)) return std::nullopt;
  if (const auto* rational = std::get_if<Rational>(from))
    return rational->numerator > 0 && rational->denominator > 0 ? std::optional(*rational) : std::nullopt;
  // Whole numbers, those of television, and else thousandths.
  constexpr double kNear = 5e-4;
  if (std::abs(rate - std::round(rate)) < kNear) return Rational{static_cast<int>(std::lround(rate)), 1};
  const auto television = static_cast<int>(std::lround(rate * 1.001));
  if (std::abs(rate - television / 1.001) < kNear) return Rational{television * 1000, 1001};
  return Rational{static_cast<int>(std::lround(rate * 1000)), 1000};
}

bool is_kept_as_text(std::string_view name) { return std::ranges::find(kNumbers, name) != kNumbers.end(); }

std::optional<MetadataValue> number_of_text(std::string_view name, std::string_view text) {
  if (const auto rational = fraction(text)) return *rational;
  const auto integer = parse_number<int>(text);
  if (integer && std::ranges::find(kWholeNumbers, name) != kWholeNumbers.end()) return *integer;
  const auto number = parse_number<float>(text);
  return number && std::isfinite(*number) ? std::optional<MetadataValue>(*number) : std::nullopt;
}

std::string text_of_number(const MetadataValue& value) {
  if (const auto* rational = std::get_if<Rational>(&value))
    return fmt::format("{}/{}", rational->numerator, rational->denominator);
  return metadata_text(value);
}

}  // namespace afterglow
