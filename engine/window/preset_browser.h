// SPDX-License-Identifier: MIT
// The presets that can be opened, each with its story and the present frame through it; a search, and a list to choose
// from.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "window/preset_list.h"
#include "window/search_field.h"
#include "window/thumbnail_cell.h"
#include "window/ui.h"

namespace afterglow {

struct PresetChoice {
  std::filesystem::path file;
  bool other = false;  ///< as B
};

/// A window over the picture. Drawing thread alone.
class PresetBrowser {
 public:
  /// Where thumbnails come from; all null: there are none.
  struct Source {
    std::function<std::shared_ptr<const Thumbnail>(const std::filesystem::path&)> find;
    std::function<void(std::vector<std::filesystem::path>)> want;
  };
  /// Opens with the keyboard in its search field. `present`: the preset that is played.
  void open(std::vector<ListedPreset> presets, const std::filesystem::path& present, Source source);
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// The preset that was chosen: by Enter, a double click or a button; with Shift as B. `unsaved`: what opening another
  /// one would lose, for people; it is asked about first.
  std::optional<PresetChoice> draw(Ui& ui, const std::string& unsaved, ImVec2 area);

 private:
  using Found = std::vector<const ListedPreset*>;
  void draw_list(Ui& ui, const Found& found, bool& entered);
  void draw_row(Ui& ui, const ListedPreset& preset, int cell, float width);
  void want_thumbnails(const Found& found, int first, int last);

  bool open_ = false, scroll_ = false;
  SearchField search_;
  std::vector<ListedPreset> presets_;
  std::filesystem::path present_;
  Source source_;
  std::size_t chosen_ = 0;                      ///< among those that are found
  std::optional<std::filesystem::path> asked_;  ///< what to open, when what would be lost was told
  std::vector<std::filesystem::path> wanted_;   ///< what was asked of `source_` last
  std::array<ThumbnailCell, AtlasCells::kThumbnails> cells_{};
};

}  // namespace afterglow
