// SPDX-License-Identifier: MIT
// The options that say which display a window shows pictures on.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/display_table.h"

namespace afterglow {

struct DisplayArguments {
  std::string config, display, view, profile;

  void add(CLI::App& command);
  bool any() const { return !(config.empty() && display.empty() && view.empty() && profile.empty()); }
  /// What they name, baked; none: nothing is named. Configurations are looked up as files, then beside `preset`, in
  /// `paths` and the rest of the search path, and among the assets. Errors: usage (options that exclude each other,
  /// names that the configuration does not have), script and io with the file.
  Result<std::optional<ShownDisplay>> shown(const std::filesystem::path& preset,
                                            const std::vector<std::string>& paths) const;

 private:
  Result<OcioRequest> request(const std::filesystem::path& preset, const std::vector<std::string>& paths) const;
};

}  // namespace afterglow
