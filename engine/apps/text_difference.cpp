// SPDX-License-Identifier: MIT
#include "apps/text_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

using Lines = std::vector<std::string>;

constexpr std::size_t kMostCells = 16u << 20;  // of the table below; beyond it all is one block

// Length of the longest common part of a from i and b from j.
class Common {
 public:
  Common(const Lines& a, const Lines& b) : width_(b.size() + 1), cells_((a.size() + 1) * width_) {
    for (std::size_t i = a.size(); i-- > 0;)
      for (std::size_t j = b.size(); j-- > 0;)
        cell(i, j) = a[i] == b[j] ? cell(i + 1, j + 1) + 1 : std::max(cell(i + 1, j), cell(i, j + 1));
  }
  unsigned& cell(std::size_t i, std::size_t j) { return cells_[i * width_ + j]; }

 private:
  std::size_t width_;
  std::vector<unsigned> cells_;
};

std::string block(const std::string& file, std::size_t line, const Lines& gone, const Lines& come) {
  std::string out = fmt::format("{}:{}\n", file, line);
  for (const auto& text : gone) out += "-" + text + "\n";
  for (const auto& text : come) out += "+" + text + "\n";
  return out;
}

}  // namespace

std::string difference_text(const std::string& file, const std::string& before, const std::string& after) {
  Lines a = split(before, '\n'), b = split(after, '\n');
  std::size_t same = 0;  // lines at the beginning
  while (same < std::min(a.size(), b.size()) && a[same] == b[same]) ++same;
  a.erase(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(same));
  b.erase(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(same));
  for (; !a.empty() && !b.empty() && a.back() == b.back(); b.pop_back()) a.pop_back();
  if (a.empty() && b.empty()) return "";
  if ((a.size() + 1) * (b.size() + 1) > kMostCells) return block(file, same + 1, a, b);

  Common common(a, b);
  std::string out;
  Lines gone, come;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      if (!gone.empty() || !come.empty()) out += block(file, same + j + 1 - come.size(), gone, come);
      gone.clear();
      come.clear();
      ++i;
      ++j;
    } else if (j == b.size() || (i < a.size() && common.cell(i + 1, j) >= common.cell(i, j + 1))) {
      gone.push_back(a[i++]);
    } else {
      come.push_back(b[j++]);
    }
  }
  if (!gone.empty() || !come.empty()) out += block(file, same + j + 1 - come.size(), gone, come);
  return out;
}

}  // namespace afterglow
