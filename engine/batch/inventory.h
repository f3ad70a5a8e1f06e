// SPDX-License-Identifier: MIT
// What a look is made of. --resume, --lock and the farm ask here, so that none of them knows more than the others.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "batch/frame_list.h"
#include "core/diagnostics.h"
#include "core/hash.h"
#include "core/result.h"
#include "image/reader.h"
#include "script/build.h"

namespace afterglow {

struct Inventory {
  /// Scripts, and shaders with their libraries: the same for every frame. When other frames may have other passes, all
  /// shaders that can be found count.
  std::set<std::filesystem::path> sources;
  Dependencies depends;  ///< of the frames that were asked about
  bool moves = false;    ///< other frames may depend on other things
};

/// Told of each frame that was evaluated.
using EachBuild = std::function<void(const Build&)>;

/// Evaluates the first frame (none: frame 1). Of a look whose settings may change, the others are asked which files
/// their settings name; those that name what none before did are evaluated, and some more. Needs no device. Errors:
/// script.
Result<Inventory> take_inventory(Preset& preset, const std::vector<BuildContext>& frames, Diagnostics& diagnostics,
                                 const EachBuild& each = {});

inline constexpr Size kUsualSize{1920, 1080};  ///< of pictures whose size nobody knows

/// Of the first of these whose header can be read; nothing of it stays open.
std::optional<PictureHeader> first_header(const std::vector<const FrameJob*>& jobs, ReadOptions options);
/// The frames as they usually are, in the size of the first: see usual_context.
std::vector<BuildContext> usual_contexts(Preset& preset, const std::vector<const FrameJob*>& jobs, double fps,
                                         const std::optional<PictureHeader>& first);

/// Hashes of files, each read once. Of those that the preset has read it is what it read then, whatever lies there by
/// now.
class FileHashes {
 public:
  explicit FileHashes(const Preset& preset) : preset_(preset) {}
  /// Errors: io.
  Result<Hash> of(const std::filesystem::path& file);

 private:
  const Preset& preset_;
  std::map<std::filesystem::path, Hash> known_;
};

/// Names of the look's files that are the same on every machine: "luts/film.cube", "installation: shaders/…".
class PortableNames {
 public:
  explicit PortableNames(const SearchPath& path);
  /// Relative to the folder of the search path that holds the file; absolute for what none does. Of those that have one
  /// name in several folders all but the first are told apart by the place of their folder: "luts/film.cube (path 2)".
  std::map<std::string, std::filesystem::path> of(const std::set<std::filesystem::path>& files) const;

  /// The same with the place of its folder, and the file that is there now: "1:luts/film.cube".
  std::string place(const std::filesystem::path& file) const;
  std::filesystem::path file_at(const std::string& place) const;

 private:
  struct Place {
    std::size_t folder = 0;  ///< of the search path; `folders_.size()`: none of them
    std::string name;
  };
  Place place_of(const std::filesystem::path& file) const;
  std::vector<std::filesystem::path> folders_;  ///< links followed, the installation last
};

}  // namespace afterglow
