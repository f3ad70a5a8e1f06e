// SPDX-License-Identifier: MIT
// OpenColorIO tries all its formats on a file, whatever it is called: what one of them could be led astray by is looked
// for in each.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "core/ascii.h"
#include "image/lut_file.h"

namespace afterglow {
namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// A size that is named in a text and larger than `most`, with what names it; empty: there is none.
std::string too_large(std::string_view text, std::string_view key, int most) {
  for (;;) {
    const auto found = std::ranges::search(text, key, same_letter);
    if (found.empty()) return {};
    text = std::string_view(found.end(), text.end());
    const std::size_t begin = text.find_first_not_of(" \t\r\n\v\f+");
    if (begin == std::string_view::npos) return {};
    const auto end = std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), is_digit);
    std::string_view digits(text.begin() + static_cast<std::ptrdiff_t>(begin), end);
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    if (digits.size() > 6 || (!digits.empty() && std::stoi(std::string(digits)) > most))
      return fmt::format("{} is {}", key, digits.substr(0, 20));
  }
}

}  // namespace

Result<void> check_table_text(const std::string& text, const std::string& file, bool may_be_profile) {
  const auto fail = [&](std::string what, std::string allowed = {}) {
    return Error{ErrorKind::script, std::move(what), file, 0, std::move(allowed), {}, {}};
  };
  // Expat, which OpenColorIO reads XML with, knows UTF-16, and puts in what a document type says: neither is searched
  // for references here.
  const bool profile = may_be_profile && text.size() >= 40 && text.compare(36, 4, "acsp") == 0 &&
                       text.find("<ProcessList") == std::string::npos;
  if (!profile && text.find('\0') != std::string::npos) return fail("is no text in ASCII or UTF-8");
  if (text.find("<!DOCTYPE") != std::string::npos) return fail("has a document type, which is not supported");
  if (text.find("<Reference") != std::string::npos) return fail("refers to another file, which is not supported");
  for (const auto& [key, most] : {std::pair("LUT_1D_SIZE", kMostLut1d), {"LUT_3D_SIZE", kMostLut3d}})
    if (std::string what = too_large(text, key, most); !what.empty())
      return fail(std::move(what), fmt::format("an integer, 2…{}", most));
  return {};
}

}  // namespace afterglow
