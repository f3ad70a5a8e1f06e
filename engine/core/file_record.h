// SPDX-License-Identifier: MIT
// What a piece of work has looked at on disk, so that it can be done again when any of that changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/hash.h"

namespace afterglow {

/// One look at a path. What was looked for in vain is a look as well.
struct FileProbe {
  enum class Kind : std::uint8_t {
    existence,  ///< is there a file or a folder?
    stamp,      ///< size, times and number of the file: for large ones
    listing,    ///< names in a folder
    content,    ///< of files above 64 MiB their stamp
  };
  Kind kind = Kind::existence;
  Hash seen;   ///< of what was found
  Hash stamp;  ///< of size, times and number of the file, taken before the look; zero: not to be relied on
};

/// By absolute path.
using FileProbes = std::map<std::filesystem::path, FileProbe>;

/// Takes down what those look at who are given it: `read_file`, `is_file`, a SearchPath. Of two looks at a path, the
/// first that says most counts. Thread-safe.
class FileRecord {
 public:
  /// One that keeps what was read: who reads a file again gets the same, whatever lies on disk by now. Files that were
  /// not there are looked for again, and what is beyond 64 MiB is read again.
  static std::shared_ptr<FileRecord> keeping();

  void note(const std::filesystem::path& path, FileProbe::Kind kind);
  /// What was looked at so far. The same value as the last time while nothing was added.
  std::shared_ptr<const FileProbes> looks() const;

  /// The content that was kept. None: it was not read, or is not kept.
  std::optional<std::string> kept(const std::filesystem::path& path) const;
  /// Whether it was read by one that keeps: then it counts as being there.
  bool keeps(const std::filesystem::path& path) const { return read_before(path).has_value(); }
  /// The hash of the content that one that keeps has read first, also where that is too large to be kept.
  std::optional<Hash> read_before(const std::filesystem::path& path) const;

  /// A content that is about to be read; `done` with what was found. Read errors are looks too. Null: notes nothing.
  class Reading {
   public:
    Reading(FileRecord* record, const std::filesystem::path& path);
    void done(std::string_view content);
    ~Reading();
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    FileRecord* record_;
    const std::filesystem::path& path_;
    Hash stamp_;   ///< FileProbe::stamp
    Hash before_;  ///< the same whether or not it is to be relied on: what a large file is known by
  };

 private:
  void add(const std::filesystem::path& path, const FileProbe& look);
  void keep(const std::filesystem::path& path, std::string_view content);
  mutable std::mutex mutex_;
  FileProbes probes_;
  bool keeps_ = false;
  std::map<std::filesystem::path, std::string> kept_;
  std::size_t kept_bytes_ = 0;
  std::map<std::filesystem::path, Hash> read_;       ///< of one that keeps
  mutable std::shared_ptr<const FileProbes> taken_;  ///< null: something was added since
};

/// A look of that kind, now.
FileProbe inspect(const std::filesystem::path& path, FileProbe::Kind kind);

/// The hash of a file's content as it was when it was looked at first, as hash_file has it. None: no content was looked
/// at, or it is above 64 MiB.
std::optional<Hash> content_seen(const FileProbes& looks, const std::filesystem::path& file);

/// All paths.
std::vector<std::filesystem::path> looked_at(const FileProbes& looks);

/// What Watcher::watch must be given to notice when looks come out differently.
std::vector<std::filesystem::path> paths_to_watch(const FileProbes& looks);

/// The first path at which one would see something else now. `trust_stamps`: contents of files whose size, times and
/// number are the same are not read again; for looking often. (Two changes within one tick of a file system's clock
/// may have the same times: stamps younger than two seconds are not trusted.)
std::optional<std::filesystem::path> first_changed(const FileProbes& looks, bool trust_stamps = false);

}  // namespace afterglow
