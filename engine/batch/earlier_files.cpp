// SPDX-License-Identifier: MIT
#include "batch/earlier_files.h"

#include <algorithm>

namespace afterglow {

void SequenceFiles::add(int number, const std::vector<std::filesystem::path>& its) {
  frames.push_back({number, files.size()});
  files.insert(files.end(), its.begin(), its.end());
}

std::size_t SequenceFiles::first_before(int number, int count) const {
  const auto own = std::ranges::lower_bound(frames, number, {}, &Frame::number) - frames.begin();
  const auto first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(own - count, 0));
  return first < frames.size() ? frames[first].begin : files.size();
}

}  // namespace afterglow
