// SPDX-License-Identifier: MIT
#include "apps/window_place.h"

#include <fmt/format.h>

#include <filesystem>
#include <regex>

#include "core/file.h"
#include "core/parse_number.h"
#include "core/user_folders.h"

namespace afterglow {
namespace {

constexpr int kLeastWidth = 480, kLeastHeight = 320, kMostSide = 16384;

std::filesystem::path place_file() {
  const auto folder = state_folder();
  return folder.empty() ? folder : folder / "window";
}

}  // namespace

Result<WindowPlace> parse_geometry(const std::string& text) {
  static const std::regex form(R"((\d{1,5})x(\d{1,5})(?:\+(-?\d{1,5})\+(-?\d{1,5}))?)");
  std::smatch found;
  if (std::regex_match(text, found, form)) {
    const auto number = [&](std::size_t i) { return parse_number<int>(found[i].str()).value_or(0); };
    const WindowPlace place{{number(1), number(2)}, found[3].matched, number(3), number(4)};
    if (place.size.width >= kLeastWidth && place.size.width <= kMostSide && place.size.height >= kLeastHeight &&
        place.size.height <= kMostSide)
      return place;
  }
  return Error{
      ErrorKind::usage, fmt::format("'{}' is no size of a window", text), "--geometry", 0,
      fmt::format("1280x720, 1280x720+100+50; {}x{} to {}x{}", kLeastWidth, kLeastHeight, kMostSide, kMostSide)};
}

std::string geometry_text(const WindowPlace& place) {
  std::string out = fmt::format("{}x{}", place.size.width, place.size.height);
  if (place.placed) out += fmt::format("+{}+{}", place.x, place.y);
  return out;
}

std::optional<WindowPlace> remembered_place() {
  const auto file = place_file();
  if (file.empty()) return std::nullopt;
  const auto text = read_file(file);
  if (!text) return std::nullopt;
  auto place = parse_geometry(text->substr(0, text->find('\n')));
  return place ? std::optional(*place) : std::nullopt;
}

void remember_place(const WindowPlace& place) {
  const auto file = place_file();
  if (file.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  (void)write_file_atomically(file, geometry_text(place) + "\n");
}

}  // namespace afterglow
