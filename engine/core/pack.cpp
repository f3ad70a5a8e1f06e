// SPDX-License-Identifier: MIT
#include "core/pack.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <system_error>
#include <vector>

#include "core/file.h"
#include "core/hash.h"
#include "core/temporary.h"
#include "core/text.h"
#include "core/zip_bytes.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kSmall = 1u << 20;  // below this, a high ratio harms nobody

struct Entry {
  std::string name;         ///< of the file that it becomes
  std::uint64_t bytes = 0;  ///< unpacked
  std::uint64_t crc = 0;    ///< of that
  unz64_file_pos place{};
};

Error refused(const fs::path& zip, const std::string& why) {
  return {ErrorKind::script, "the pack is refused: " + why, zip.string()};
}

// Names in messages: they may hold anything.
std::string in_quotes(const std::string& name) {
  std::string out = name.substr(0, 80);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return "'" + out + "'";
}

// Why the entry may not be unpacked; empty when it may.
std::string fault_of(const unz_file_info64& info, const std::string& name, const PackLimits& limits) {
  if (!is_safe_entry(name, limits.depth)) return in_quotes(name) + " is not the name of a file inside it";
  const auto mode = static_cast<mode_t>(info.external_fa >> 16) & S_IFMT;
  if (mode != 0 && mode != S_IFREG && mode != S_IFDIR) return in_quotes(name) + " is a link or a device";
  if ((info.flag & 1) != 0) return in_quotes(name) + " is encrypted";
  if (info.uncompressed_size > limits.file_bytes)
    return fmt::format("{} is larger than {} MiB", in_quotes(name), limits.file_bytes >> 20);
  if (info.uncompressed_size > kSmall && info.uncompressed_size / limits.ratio > info.compressed_size)
    return fmt::format("{} grows more than {} times", in_quotes(name), limits.ratio);
  return {};
}

/// What systems add to a zip for themselves.
bool is_noise(const std::string& name) {
  return name.starts_with("__MACOSX/") || fs::path(name).filename() == ".DS_Store";
}

// Everything that the zip says it holds, checked; nothing is unpacked.
Result<std::vector<Entry>> list_entries(unzFile zip, const fs::path& path, const PackLimits& limits) {
  std::vector<Entry> entries;
  std::set<std::string> names;  // without case: not every file system tells case apart
  std::uint64_t total = 0;
  std::size_t count = 0;
  for (int status = unzGoToFirstFile(zip); status != UNZ_END_OF_LIST_OF_FILE; status = unzGoToNextFile(zip)) {
    std::array<char, 1024> name{};
    unz_file_info64 info{};
    if (status != UNZ_OK ||
        unzGetCurrentFileInfo64(zip, &info, name.data(), name.size() - 1, nullptr, 0, nullptr, 0) != UNZ_OK)
      return refused(path, "it is damaged");
    if (++count > limits.files) return refused(path, fmt::format("it holds more than {} files", limits.files));
    if (info.size_filename >= name.size() - 1) return refused(path, "a name in it is too long");
    Entry entry{std::string(name.data(), info.size_filename), info.uncompressed_size, info.crc, {}};
    if (auto fault = fault_of(info, entry.name, limits); !fault.empty()) return refused(path, fault);
    if (!names.insert(lower(entry.name)).second) return refused(path, in_quotes(entry.name) + " is there twice");
    total += entry.bytes;
    if (total > limits.total_bytes)
      return refused(path, fmt::format("it unpacks to more than {} MiB", limits.total_bytes >> 20));
    if (entry.name.ends_with('/') || is_noise(entry.name)) continue;
    if (unzGetFilePos64(zip, &entry.place) != UNZ_OK) return refused(path, "it is damaged");
    entries.push_back(std::move(entry));
  }
  if (entries.empty()) return refused(path, "it holds no files");
  return entries;
}

/// A folder that was zipped whole is a pack as its content is: the folder's own name goes, when it looks like a pack
/// and all lies in it but files beside it that are no scripts (a readme), which are left out. `stem`: the zip's name
/// without ".zip"; a folder of that name is no library.
void drop_folder_around(std::vector<Entry>& entries, const std::string& stem) {
  static constexpr std::array<std::string_view, 4> kParts{"presets", "effects", "masks", "shaders"};
  static constexpr std::array<std::string_view, 3> kLibraries{"lib", "luts", "scripts"};
  const auto is_part = [&](const std::string& folder) { return std::ranges::find(kParts, folder) != kParts.end(); };
  const auto is_beside = [](const Entry& entry) {
    return entry.name.find('/') == std::string::npos && !entry.name.ends_with(".lua");
  };
  const auto inner = std::ranges::find_if_not(entries, is_beside);
  if (inner == entries.end()) return;
  const std::string around = inner->name.substr(0, inner->name.find('/') + 1);
  const std::string name = around.substr(0, around.empty() ? 0 : around.size() - 1);
  const auto lies_in_it = [&](const Entry& entry) { return entry.name.starts_with(around) || is_beside(entry); };
  if (around.empty() || is_part(name) || !std::ranges::all_of(entries, lies_in_it)) return;
  const bool may_hold_looks = name == stem || std::ranges::find(kLibraries, name) == kLibraries.end();
  const bool is_pack = std::ranges::any_of(entries, [&](const Entry& entry) {
    if (is_beside(entry)) return false;
    const fs::path inside(entry.name.substr(around.size()));
    return is_part(inside.begin()->string()) ||
           (may_hold_looks && !inside.has_parent_path() && inside.extension() == ".lua");
  });
  if (!is_pack) return;
  std::erase_if(entries, is_beside);
  for (auto& entry : entries) entry.name.erase(0, around.size());
}

Result<std::string> unpack(unzFile zip, const fs::path& path, const Entry& entry) {
  const Error damaged = refused(path, in_quotes(entry.name) + " is damaged");
  if (unzGoToFilePos64(zip, &entry.place) != UNZ_OK || unzOpenCurrentFile(zip) != UNZ_OK) return damaged;
  std::string content;
  std::array<char, 65536> buffer;
  int got = 0;
  // Headers lie: what comes out is counted, not believed.
  while ((got = unzReadCurrentFile(zip, buffer.data(), buffer.size())) > 0 && content.size() <= entry.bytes)
    content.append(buffer.data(), static_cast<std::size_t>(got));
  const bool whole = unzCloseCurrentFile(zip) == UNZ_OK && got == 0 && content.size() == entry.bytes;
  if (!whole) return damaged;
  return content;
}

/// A size alone may be that of a file whose blocks were lost, or of one that was edited.
bool is_whole(const fs::path& folder, const std::vector<Entry>& entries) {
  return std::ranges::all_of(entries, [&](const Entry& entry) {
    const auto content = read_file(folder / entry.name, entry.bytes);
    return content && content->size() == entry.bytes &&
           crc32_z(0, reinterpret_cast<const Bytef*>(content->data()), content->size()) == entry.crc;
  });
}

Result<void> unpack_all(unzFile zip, const fs::path& path, const std::vector<Entry>& entries, const fs::path& folder) {
  for (const auto& entry : entries) {
    AFTERGLOW_TRY(const std::string content, unpack(zip, path, entry));
    const fs::path file = folder / entry.name;
    std::error_code ec;
    fs::create_directories(file.parent_path(), ec);
    std::ofstream out(file, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) return Error{ErrorKind::io, "cannot be written", file.string()};
  }
  return {};
}

}  // namespace

bool is_safe_entry(const std::string& name, std::size_t depth) {
  if (name.empty() || name.size() > 400 || name.front() == '/') return false;
  for (const unsigned char c : name)
    if (c < 0x20 || c == 0x7F || c == '\\' || c == ':' || c == '*' || c == '?' || c == '"' || c == '<' || c == '>' ||
        c == '|')
      return false;
  auto parts = split(name, '/');
  if (parts.back().empty()) parts.pop_back();  // a folder
  return parts.size() <= depth + 1 && std::ranges::none_of(parts, [](const std::string& part) {
           return part.empty() || part == "." || part == ".." || part.size() > 200;
         });
}

bool is_zip(const fs::path& path) {
  std::error_code ec;
  return lower(path.extension().string()) == ".zip" && fs::is_regular_file(path, ec);
}

Result<fs::path> open_zip(const fs::path& path, const fs::path& cache, const PackLimits& limits) {
  auto bytes = read_file(path, limits.zip_bytes);
  if (!bytes) return Error{ErrorKind::script, bytes.error().message, path.string()};
  const Zip zip = open_zip_bytes(*bytes);
  if (!zip) return refused(path, "it is no zip");
  AFTERGLOW_TRY(std::vector<Entry> entries, list_entries(zip.get(), path, limits));
  drop_folder_around(entries, path.stem().string());

  // The zip's own name comes last, so that messages about its files read like NAME.zip/effects/….lua.
  const std::string name = path.filename().string();
  const fs::path home = cache / "packs" / Hasher().add(name).add(*bytes).finish().hex();
  const fs::path folder = home / name;
  if (is_whole(folder, entries)) return folder;
  Temporary temporary(home);
  std::error_code ec;
  fs::create_directories(temporary.path() / name, ec);
  AFTERGLOW_CHECK(unpack_all(zip.get(), path, entries, temporary.path() / name));
  if (!temporary.commit() && !is_whole(folder, entries)) {  // left damaged
    fs::remove_all(home, ec);
    (void)temporary.commit();
  }
  if (!is_whole(folder, entries)) return Error{ErrorKind::io, "cannot be written", folder.string()};
  return folder;
}

std::string pack_of(const fs::path& file, const fs::path& cache) {
  std::error_code ec;
  const fs::path inside = fs::weakly_canonical(file, ec).lexically_relative(fs::weakly_canonical(cache / "packs", ec));
  const std::vector<fs::path> parts(inside.begin(), inside.end());
  return parts.size() > 2 && parts[0] != ".." ? parts[1].string() : "";  // HASH/NAME.zip/…
}

}  // namespace afterglow
