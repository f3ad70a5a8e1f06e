// SPDX-License-Identifier: MIT
#include "core/written_files.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/file.h"
#include "core/temporary.h"
#include "core/text.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAllowed = "another name";

Error refused(const fs::path& file, std::string why) {
  return {ErrorKind::usage, std::move(why), file.string(), 0, kAllowed};
}

/// What a file is, whatever it is called: where it lies on a device, or where it would lie.
struct Place {
  dev_t device = 0;
  ino_t number = 0;
  fs::path path;  ///< of one that is not there
  auto operator<=>(const Place&) const = default;
};

/// That it lies in, behind links.
fs::path folder_of(const fs::path& file) {
  std::error_code ec;
  const fs::path target = behind_links(file);
  return fs::weakly_canonical(target.has_parent_path() ? target.parent_path() : fs::path("."), ec);
}

Place place_of(const fs::path& file) {
  struct stat found {};
  if (stat(file.c_str(), &found) == 0) return {found.st_dev, found.st_ino, {}};
  return {0, 0, folder_of(file) / behind_links(file).filename()};
}

/// One that is read: itself, or the pack that it lies in. None: it is not there.
std::optional<Place> place_of_read(fs::path file) {
  struct stat found {};
  while (stat(file.c_str(), &found) != 0) {
    if (errno != ENOTDIR || !file.has_relative_path()) return std::nullopt;
    file = file.parent_path();
  }
  return Place{found.st_dev, found.st_ino, {}};
}

/// How files of a form begin, behind white space; for messages its name comes first.
std::span<const std::string_view> beginnings(FileForm form) {
  static constexpr std::array<std::string_view, 3> kJson{"JSON", "{", "["};
  static constexpr std::array<std::string_view, 4> kDot{"graph", "digraph", "graph", "strict"};
  static constexpr std::array<std::string_view, 3> kSvg{"SVG", "<svg", "<?xml"};
  if (form == FileForm::json) return kJson;
  if (form == FileForm::dot) return kDot;
  if (form == FileForm::svg) return kSvg;
  return {};
}

/// Whether what lies there is of the form, or nothing.
Result<void> check_form(const SideFile& side) {
  const auto known = beginnings(side.form);
  std::error_code ec;
  if (known.empty() || !fs::is_regular_file(side.file, ec)) return {};
  std::array<char, 256> head{};
  std::ifstream in(side.file, std::ios::binary);
  in.read(head.data(), head.size());
  const std::string text = trim({head.data(), static_cast<std::size_t>(in.gcount())});
  if (text.empty() || starts_with_any(text, known.subspan(1))) return {};
  return refused(side.file, fmt::format("is no {} file, and {} would replace it", known.front(), side.option));
}

/// A file beside the results is written last: that its folder takes none would be found out behind all the work.
Result<void> check_folder(const SideFile& side, const fs::path& to_be_made) {
  const fs::path folder = folder_of(side.file);
  if (access(folder.c_str(), W_OK | X_OK) == 0) return {};
  const int reason = errno;
  if (reason == ENOENT && !to_be_made.empty() && folder == folder_of(to_be_made / "file")) return {};
  return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(reason)), side.file.string()};
}

}  // namespace

Result<void> check_written(std::span<const SideFile> sides, std::span<const fs::path> outputs,
                           std::span<const fs::path> read, const fs::path& to_be_made) {
  std::map<Place, fs::path> taken;
  for (const auto& file : read)
    if (auto place = place_of_read(file)) taken.emplace(*std::move(place), file);
  std::map<Place, std::string> written;
  for (const auto& output : outputs) {
    if (output.empty() || output == "-") continue;
    Place place = place_of(output);
    if (const auto found = taken.find(place); found != taken.end())
      return refused(output, fmt::format("is read as {}, and a result would replace it", found->second.string()));
    written.emplace(std::move(place), "a result");
  }
  for (const auto& side : sides) {
    if (side.file.empty() || side.file == "-" || is_stream(side.file)) continue;
    Place place = place_of(side.file);
    if (taken.contains(place)) return refused(side.file, fmt::format("is read, and {} would replace it", side.option));
    const auto [other, is_new] = written.emplace(std::move(place), side.option);
    if (!is_new)
      return refused(side.file, fmt::format("{} and {} would both be written there", other->second, side.option));
    AFTERGLOW_CHECK(check_form(side));
    AFTERGLOW_CHECK(check_replaceable(side.file));
    AFTERGLOW_CHECK(check_folder(side, to_be_made));
  }
  return {};
}

}  // namespace afterglow
