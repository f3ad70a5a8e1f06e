// SPDX-License-Identifier: MIT
#include "core/file_record.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

namespace afterglow {
namespace fs = std::filesystem;
namespace {

using Kind = FileProbe::Kind;

constexpr std::uint64_t kNothing = 1, kFile = 2, kFolder = 3, kOther = 4, kUnreadable = 5;  // first word of a Hash
constexpr std::size_t kLargest = 64u << 20;     // bytes that are read to compare contents; larger files by their stamps
constexpr std::size_t kMostKept = 64u << 20;    // bytes
constexpr std::int64_t kYoung = 2'000'000'000;  // ns; FAT counts in steps of two seconds

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

Hash stamp_of(const struct stat& status) {
  return Hasher()
      .add(static_cast<std::uint64_t>(status.st_dev))
      .add(static_cast<std::uint64_t>(status.st_ino))
      .add(static_cast<std::uint64_t>(status.st_size))
      .add(static_cast<std::uint64_t>(nanoseconds(status.st_mtim)))
      .add(static_cast<std::uint64_t>(nanoseconds(status.st_ctim)))
      .finish();
}

Hash existence(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {kNothing, 0};
  return {S_ISREG(status.st_mode) ? kFile : S_ISDIR(status.st_mode) ? kFolder : kOther, 0};
}

/// Zero for what is young enough to change again unnoticed.
Hash trusted_stamp(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t age = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() -
                           std::max(nanoseconds(status.st_mtim), nanoseconds(status.st_ctim));
  return age > kYoung ? stamp_of(status) : Hash{};
}

Hash stamp(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? stamp_of(status) : Hash{kNothing, 0};
}

Hash listing(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::directory_iterator it(path, ec), end; !ec && it != end; it.increment(ec))
    names.push_back(it->path().filename().string());
  if (ec) return existence(path);
  std::sort(names.begin(), names.end());
  Hasher hasher;
  for (const auto& name : names) hasher.add(name);
  return hasher.finish();
}

/// Reads the file anew, without a limit of the caller's: the same for the same file, whoever asks.
Hash content(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {kNothing, 0};
  if (!S_ISREG(status.st_mode)) return existence(path);
  if (static_cast<std::uint64_t>(status.st_size) > kLargest) return stamp_of(status);
  std::ifstream in(path, std::ios::binary);
  if (!in) return {kUnreadable, 0};
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return in.bad() ? Hash{kUnreadable, 0} : hash_text(text);
}

Hash look(const fs::path& path, Kind kind) {
  switch (kind) {
    case Kind::existence:
      return existence(path);
    case Kind::stamp:
      return stamp(path);
    case Kind::listing:
      return listing(path);
    default:
      return content(path);
  }
}

fs::path whole_path(const fs::path& path) {
  std::error_code ec;
  fs::path whole = fs::absolute(path, ec);
  return ec ? path : whole;
}

}  // namespace

FileProbe inspect(const fs::path& path, Kind kind) { return {kind, look(path, kind), {}}; }

std::shared_ptr<FileRecord> FileRecord::keeping() {
  auto record = std::make_shared<FileRecord>();
  record->keeps_ = true;
  return record;
}

std::optional<std::string> FileRecord::kept(const fs::path& path) const {
  if (!keeps_) return std::nullopt;
  const std::lock_guard lock(mutex_);
  const auto known = kept_.find(whole_path(path));
  return known == kept_.end() ? std::nullopt : std::optional(known->second);
}

std::optional<Hash> FileRecord::read_before(const fs::path& path) const {
  if (!keeps_) return std::nullopt;
  const std::lock_guard lock(mutex_);
  const auto known = read_.find(whole_path(path));
  return known == read_.end() ? std::nullopt : std::optional(known->second);
}

void FileRecord::keep(const fs::path& path, std::string_view content) {
  if (!keeps_) return;
  const Hash hash = hash_text(content);
  const std::lock_guard lock(mutex_);
  if (!read_.emplace(whole_path(path), hash).second) return;
  if (content.size() > kMostKept - kept_bytes_) return;
  kept_.emplace(whole_path(path), content);
  kept_bytes_ += content.size();
}

void FileRecord::add(const fs::path& path, const FileProbe& look) {
  const std::lock_guard lock(mutex_);
  const auto [known, fresh] = probes_.emplace(whole_path(path), look);
  if (!fresh && known->second.kind >= look.kind) return;
  known->second = look;
  taken_.reset();
}

void FileRecord::note(const fs::path& path, Kind kind) { add(path, inspect(path, kind)); }

std::shared_ptr<const FileProbes> FileRecord::looks() const {
  const std::lock_guard lock(mutex_);
  if (!taken_) taken_ = std::make_shared<const FileProbes>(probes_);
  return taken_;
}

FileRecord::Reading::Reading(FileRecord* record, const fs::path& path) : record_(record), path_(path) {
  if (!record_) return;
  stamp_ = trusted_stamp(path);
  before_ = stamp(path);
}

void FileRecord::Reading::done(std::string_view content) {
  if (record_) {
    record_->add(path_, {Kind::content, content.size() > kLargest ? before_ : hash_text(content), stamp_});
    record_->keep(path_, content);
  }
  record_ = nullptr;
}

FileRecord::Reading::~Reading() {
  if (record_) record_->add(path_, {Kind::content, content(path_), stamp_});
}

std::optional<Hash> content_seen(const FileProbes& looks, const fs::path& file) {
  const auto known = looks.find(whole_path(file));
  struct stat status {};
  if (known == looks.end() || known->second.kind != Kind::content || known->second.seen.high <= kUnreadable ||
      stat(file.c_str(), &status) != 0 || static_cast<std::uint64_t>(status.st_size) > kLargest)
    return std::nullopt;
  return known->second.seen;
}

std::vector<fs::path> looked_at(const FileProbes& looks) {
  std::vector<fs::path> paths;
  for (const auto& [path, known] : looks) paths.push_back(path);
  return paths;
}

std::vector<fs::path> paths_to_watch(const FileProbes& looks) {
  std::vector<fs::path> paths;
  for (const auto& [path, known] : looks) paths.push_back(known.kind == Kind::listing ? path / "" : path);
  return paths;
}

std::optional<fs::path> first_changed(const FileProbes& looks, bool trust_stamps) {
  for (const auto& [path, known] : looks) {
    const bool trusted = trust_stamps && known.kind == Kind::content && known.stamp != Hash{};
    if (trusted && stamp(path) == known.stamp) continue;
    if (look(path, known.kind) != known.seen) return path;
  }
  return std::nullopt;
}

}  // namespace afterglow
