// SPDX-License-Identifier: MIT
// Frames that people have marked, by clip and number; kept from one call to the next.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "play/footage.h"

namespace afterglow {

/// A marked frame of the row that is played.
struct Marker {
  int position = 0;
  std::string name;  ///< may be empty
};

/// Each clip has a file of its own in `folder`: its path in a line, then "NUMBER NAME" a line. A marker belongs to the
/// frame's number in its clip: it stays there when frames come before it or the clip is played between others.
/// Drawing thread alone.
class Markers {
 public:
  /// Empty: markers last as long as this.
  explicit Markers(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Call before each use: reads the markers of clips that are new. What is not a marker in a file is passed over.
  void follow(const std::shared_ptr<const Footage>& footage);
  /// In order; those whose frame is not played are left out.
  const std::vector<Marker>& all() const { return shown_; }
  std::optional<Marker> at(int position) const;
  /// The nearest behind or before a position; none: there is none that way.
  std::optional<Marker> next(int position) const;
  std::optional<Marker> previous(int position) const;

  /// Sets or clears; true: it is marked now. Errors: io, when it could not be kept: it holds until the end all the
  /// same.
  Result<bool> toggle(int position);
  /// Marks it when it is not. Line breaks become spaces. Errors: as toggle.
  Result<void> name(int position, const std::string& text);

  /// The file for a clip with that key (Footage::Clip::key).
  std::filesystem::path file(const std::string& key) const;

 private:
  using Numbers = std::map<int, std::string>;  ///< of one clip
  Numbers read(const std::string& key) const;
  Result<void> change(const std::string& key, const std::function<void(Numbers&)>& made);
  void list();
  int number(int position) const { return footage_->frame(position).number; }

  std::filesystem::path folder_;
  std::shared_ptr<const Footage> footage_;
  std::map<std::string, Numbers> clips_;
  std::vector<Marker> shown_;
};

}  // namespace afterglow
