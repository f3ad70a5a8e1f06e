// SPDX-License-Identifier: MIT
// OpenColorIO tries all its formats on a file, whatever it is called: what one of them could be led astray by is looked
// for in each.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "core/ascii.h"
#include "core/parse_number.h"
#include "core/text.h"
#include "core/utf16.h"
#include "image/lut_file.h"

namespace afterglow {
namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

struct Limit {
  std::string_view key;
  int most;
};
constexpr std::array kLimits{Limit{"LUT_1D_SIZE", kMostLut1d}, Limit{"LUT_3D_SIZE", kMostLut3d}};

/// The digits of the number behind the name of a size, without zeros before it.
std::string_view size_behind(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\v\f+"), text.size()));
  text = text.substr(0, static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin()));
  return text.substr(std::min(text.find_first_not_of('0'), text.size()));
}

/// A size that is larger than its limit. Tables are long and have few underscores: those are looked for.
Result<void> check_sizes(std::string_view text, const std::string& file) {
  constexpr std::size_t kBefore = 3;  // "LUT"
  for (auto at = text.find('_'); at != std::string_view::npos; at = text.find('_', at + 1)) {
    const std::string_view name = at < kBefore ? std::string_view() : text.substr(at - kBefore);
    for (const auto& [key, most] : kLimits) {
      if (!std::ranges::equal(name.substr(0, key.size()), key, same_letter)) continue;
      const std::string_view digits = size_behind(name.substr(key.size()));
      const auto size = parse_number<int>(digits);
      if (digits.empty() || (size && *size <= most)) continue;
      return Error{ErrorKind::script, fmt::format("{} is {}", key, digits.substr(0, 20)), file, 0,
                   fmt::format("an integer, 2…{}", most)};
    }
  }
  return {};
}

bool is_profile(std::string_view text) {
  return text.substr(std::min<std::size_t>(text.size(), 36)).starts_with("acsp") &&
         text.find("<ProcessList") == std::string_view::npos;
}

}  // namespace

Result<void> check_table(const std::string& text, const std::filesystem::path& path, TableUse use) {
  const std::string file = path.string();
  if (is_utf16(text)) return Error{ErrorKind::script, kUtf16, file};
  if (lower(path.extension().string()) == ".cube") AFTERGLOW_CHECK(check_cube(text, file));
  const auto fail = [&](std::string what) { return Error{ErrorKind::script, std::move(what), file}; };
  // Expat, which OpenColorIO reads XML with, knows UTF-16, and puts in what a document type says: neither is searched
  // for references here.
  const bool profile = use == TableUse::of_config && is_profile(text);
  if (!profile && text.find('\0') != std::string::npos) return fail("is no text in ASCII or UTF-8");
  if (text.find("<!DOCTYPE") != std::string::npos) return fail("has a document type, which is not supported");
  if (text.find("<Reference") != std::string::npos) return fail("refers to another file, which is not supported");
  return check_sizes(text, file);
}

}  // namespace afterglow
