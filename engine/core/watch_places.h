// SPDX-License-Identifier: MIT
// Where something must happen for a path to mean something else. Internal to the room.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>

namespace afterglow {

/// A name in a folder (its real path: no links in it).
struct WatchPlace {
  std::string folder, name;  ///< name "*": any
  bool content = false;      ///< its content matters, not only whether it is there
  friend auto operator<=>(const WatchPlace&, const WatchPlace&) = default;
};

/// Every step that the system takes to find the path, links followed, up to the first that leads nowhere. A path that
/// ends in '/' names the entries of a folder.
std::set<WatchPlace> watch_places(const std::filesystem::path& path);

/// Why changes in a folder may happen without notice: a network file system; empty when they do not.
std::string why_unnoticed(const std::string& folder);

}  // namespace afterglow
