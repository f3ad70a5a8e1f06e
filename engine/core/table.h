// SPDX-License-Identifier: MIT
// Columns of text, as wide as they need to be.
#pragma once

#include <string>
#include <vector>

namespace afterglow {

/// Left-aligned columns two spaces apart; the last column is not padded. Widths count code points (UTF-8). A row is
/// one line: line feeds within it are shown as "\\n".
class Table {
 public:
  /// Without a header when it is empty.
  explicit Table(std::vector<std::string> header = {}) {
    if (!header.empty()) add(std::move(header));
  }
  void add(std::vector<std::string> row);
  /// Lines that start with `indent`, each ended by a newline.
  std::string text(const std::string& indent = "") const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace afterglow
