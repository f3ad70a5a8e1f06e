// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "core/ascii.h"
#include "core/decomposed.h"
#include "core/text.h"
#include "image/picture_format.h"
#include "image/sequence.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// Files that differ in a number alone.
struct Numbered {
  std::size_t digits = kMostFrameDigits + 1, files = 0;
  fs::path example;
  std::pair<std::string, std::string> name;  ///< before and behind the number, as one of the files has it
};
/// By what stands before and behind the number, with letters and marks put together.
using NumberedGroups = std::map<std::pair<std::string, std::string>, Numbered>;

bool is_picture(const fs::path& file) {
  return !picture_format(file).empty() || lower(file.extension().string()) == ".exr";
}

/// Notes a file by the last number in its name, the extension left out; in `long_ones` where that has too many digits,
/// in `others` where there is none.
void note_name(NumberedGroups& groups, const fs::path& file, LeftOut& long_ones, LeftOut& others) {
  const std::string name = file.filename().string();
  if (name.starts_with('.') || name.find('#') != std::string::npos) return;
  const auto [begin, end, digits] = frame_number(file);
  if (digits == 0) {
    if (is_picture(file)) others.add(file);
    return;
  }
  if (digits > kMostFrameDigits) {
    if (is_picture(file)) long_ones.add(file);
    return;
  }
  const std::pair parts{name.substr(0, begin), name.substr(end)};
  Numbered& group = groups[{put_together(parts.first), put_together(parts.second)}];
  if (group.files == 0 || parts < group.name) group.name = parts;
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
  return (folder / with_percents(name.first)).string() + std::string(digits, '#') + with_percents(name.second);
}

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::is_regular_file(file, none);
}

/// Whether the pattern's name of the frame is this one, and a frame beside it is there. `over_zero`: so is frame 0.
bool is_around(const Pattern& pattern, int frame, const fs::path& file, bool over_zero) {
  const auto named = [&](const fs::path& name) { return name.filename() == file.filename(); };
  if (!named(pattern.file(frame)) && !named(pattern.file_with_sign(frame))) return false;
  if (over_zero && !is_there(pattern.file(0))) return false;
  return is_there(pattern.existing(frame - 1)) || is_there(pattern.existing(frame + 1));
}

}  // namespace

Result<std::string> sequence_in(const fs::path& folder, LeftOut* others) {
  NumberedGroups groups;
  LeftOut long_ones, unnumbered;
  std::error_code ec, ignored;
  fs::directory_iterator it(folder, ec);
  for (const fs::directory_iterator end; !ec && it != end; it.increment(ec))
    if (it->is_regular_file(ignored)) note_name(groups, it->path(), long_ones, unnumbered);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be read: {}", ec.message()), folder.string()};
  std::vector<std::string> found;
  for (const auto& [parts, group] : groups)
    if (is_picture(group.example))
      found.push_back(pattern_of(folder, group.name, std::min<std::size_t>(group.digits, kMostFrameDigits)));
  if (others) *others = unnumbered;
  if (found.size() == 1) return found.front();
  constexpr std::size_t kMostNamed = 4;
  Error error{ErrorKind::io,
              found.empty() ? "the folder holds no numbered pictures" : "the folder holds several sequences",
              folder.string()};
  if (found.empty() && long_ones.files > 0)
    error.message += fmt::format(": {} has more than {} digits", long_ones.first.filename().string(), kMostFrameDigits);
  if (found.size() > kMostNamed) found.resize(kMostNamed), found.emplace_back("…");
  error.allowed = found.empty() ? "a folder with files like shot.0001.exr" : join(found);
  return error;
}

std::optional<SequenceFrame> sequence_around(const fs::path& file) {
  NumberedGroups own;
  LeftOut ignored;
  note_name(own, file, ignored, ignored);
  if (own.empty() || !is_picture(file) || !is_there(file)) return std::nullopt;
  const Numbered& group = own.begin()->second;
  const auto& name = group.name;
  const std::string written = file.filename().string().substr(name.first.size(), group.digits);
  const int frame = std::stoi(written);
  // A number that begins with 0 tells how many digits all have; others may come from 9 or from 99. Before zero the sign
  // may count among them or not, which frame 0 tells.
  for (const bool over_zero : {true, false}) {
    if (over_zero && frame >= 0) continue;
    for (std::size_t digits = std::min<std::size_t>(written.size(), kMostFrameDigits); digits >= 1; --digits) {
      const std::string text = pattern_of(file.parent_path(), name, digits);
      if (const auto pattern = parse_pattern(text); pattern && is_around(*pattern, frame, file, over_zero))
        return SequenceFrame{text, frame};
    }
  }
  return std::nullopt;
}

std::vector<std::string> in_sequences(const std::vector<std::string>& pictures) {
  std::vector<std::string> out;
  for (const std::string& picture : pictures) {
    const auto around = sequence_around(picture);
    const std::string& input = around ? around->pattern : picture;
    if (std::ranges::find(out, input) == out.end()) out.push_back(input);
  }
  return out;
}

Result<std::vector<std::string>> with_sequences(std::vector<std::string> inputs, Diagnostics& diagnostics) {
  for (auto& input : inputs) {
    std::error_code ec;
    if (!fs::is_directory(input, ec)) continue;
    LeftOut others;
    const std::string folder = input;
    AFTERGLOW_TRY(input, sequence_in(folder, &others));
    if (others.files > 0)
      diagnostics.warn_once("unnumbered " + folder,
                            fmt::format("{}: {} left out: a folder stands for its numbered pictures; others are given "
                                        "by their names",
                                        folder, others.names()));
  }
  return inputs;
}

}  // namespace afterglow
