// SPDX-License-Identifier: MIT
// The effects that can be added to a stack, with what their scripts say about them and what they make of the present
// frame; a search, and a list to choose from.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "core/paths.h"
#include "script/schema.h"
#include "window/search_field.h"
#include "window/thumbnail_cell.h"
#include "window/ui.h"

namespace afterglow {

/// Effects and masks of a preset's search path; their scripts run on a thread of their own.
class EffectLibrary {
 public:
  /// Reads them anew, in the background; what was read before stays until then.
  void read(const SearchPath& path);
  /// Takes what was read; in each turn.
  void poll();
  bool reading() const { return running_.valid(); }
  const std::vector<EffectSchema>& effects() const { return read_.effects; }
  const std::vector<EffectSchema>& masks() const { return read_.masks; }

 private:
  struct Read {
    std::vector<EffectSchema> effects, masks;
  };
  Read read_;
  std::future<Read> running_;
};

/// A window over the picture. Drawing thread alone.
class EffectBrowser {
 public:
  /// Where pictures come from: of the frame with one effect more, "" as it is. All null: there are none.
  struct Source {
    std::function<std::shared_ptr<const Thumbnail>(const std::string& effect)> find;
    std::function<void(std::vector<std::string>)> want;  ///< the most urgent first
  };
  /// Opens with the keyboard in its search field.
  void open(Source source);
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// The name of the effect that was chosen: by Enter, a double click or the button.
  std::optional<std::string> draw(Ui& ui, const EffectLibrary& library, ImVec2 at, ImVec2 size);

 private:
  bool found(const EffectSchema& effect) const;
  void draw_page(Ui& ui, const EffectSchema& effect);
  void draw_pictures(Ui& ui, const EffectSchema& effect);
  void want_pictures(const std::vector<const EffectSchema*>& list);

  bool open_ = false, scroll_ = false, entered_ = false;
  SearchField search_;
  std::size_t chosen_ = 0;  ///< among those that are found
  Source source_;
  std::vector<std::string> wanted_;  ///< what was asked of it last
  ThumbnailCell before_, after_;
};

}  // namespace afterglow
