// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "core/ascii.h"
#include "core/text.h"
#include "image/picture_format.h"
#include "image/sequence.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostFrameDigits = 9;

/// Files that differ in a number alone.
struct Numbered {
  std::size_t digits = kMostFrameDigits, files = 0;
  fs::path example;
};
/// By what stands before and behind the number.
using NumberedGroups = std::map<std::pair<std::string, std::string>, Numbered>;

/// Notes a file by the last number in its name, the extension left out.
void note_name(NumberedGroups& groups, const fs::path& file) {
  const std::string name = file.filename().string(), stem = file.stem().string();
  if (name.starts_with('.') || name.find('#') != std::string::npos) return;
  std::size_t end = stem.size();
  while (end > 0 && !is_digit(stem[end - 1])) --end;
  const std::size_t begin = number_begin(stem, end);
  if (begin == end || end - begin > kMostFrameDigits) return;
  Numbered& group = groups[{name.substr(0, begin), name.substr(end)}];
  group.digits = std::min(group.digits, end - begin);
  ++group.files;
  group.example = file;
}

/// As a pattern writes it.
std::string with_percents(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '%' ? std::string("%%") : std::string(1, c);
  return out;
}

std::string pattern_of(const fs::path& folder, const std::pair<std::string, std::string>& name, std::size_t digits) {
  return with_percents((folder / name.first).string()) + std::string(digits, '#') + with_percents(name.second);
}

bool is_picture(const fs::path& file) {
  return !picture_format(file).empty() || lower(file.extension().string()) == ".exr";
}

}  // namespace

Result<std::string> sequence_in(const fs::path& folder) {
  NumberedGroups groups;
  std::error_code ec, ignored;
  fs::directory_iterator it(folder, ec);
  for (const fs::directory_iterator end; !ec && it != end; it.increment(ec))
    if (it->is_regular_file(ignored)) note_name(groups, it->path());
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be read: {}", ec.message()), folder.string()};
  std::vector<std::string> found;
  for (const auto& [name, group] : groups)
    if (is_picture(group.example)) found.push_back(pattern_of(folder, name, group.digits));
  if (found.size() == 1) return found.front();
  constexpr std::size_t kMostNamed = 4;
  Error error{ErrorKind::io,
              found.empty() ? "the folder holds no numbered pictures" : "the folder holds several sequences",
              folder.string()};
  if (found.size() > kMostNamed) found.resize(kMostNamed), found.emplace_back("…");
  error.allowed = found.empty() ? "a folder with files like shot.0001.exr" : join(found);
  return error;
}

std::optional<SequenceFrame> sequence_around(const fs::path& file) {
  std::error_code none;
  NumberedGroups own;
  note_name(own, file);
  if (own.empty() || !is_picture(file) || !fs::is_regular_file(file, none)) return std::nullopt;
  const auto& [name, group] = *own.begin();
  const std::string written = file.filename().string().substr(name.first.size(), group.digits);
  const int frame = std::stoi(written);
  // A number that begins with 0 tells how many digits all have; others may come from 9 or from 99.
  for (std::size_t digits = written.size(); digits >= 1; --digits) {
    const std::string text = pattern_of(file.parent_path(), name, digits);
    const auto pattern = parse_pattern(text);
    if (!pattern || pattern->file(frame).filename() != file.filename()) continue;
    const bool follows = frame > 0 && fs::is_regular_file(pattern->file(frame - 1), none);
    if (follows || fs::is_regular_file(pattern->file(frame + 1), none)) return SequenceFrame{text, frame};
  }
  return std::nullopt;
}

Result<std::vector<std::string>> with_sequences(std::vector<std::string> inputs) {
  for (auto& input : inputs) {
    std::error_code ec;
    if (!fs::is_directory(input, ec)) continue;
    AFTERGLOW_TRY(input, sequence_in(input));
  }
  return inputs;
}

}  // namespace afterglow
