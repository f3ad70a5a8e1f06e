// SPDX-License-Identifier: MIT
// What the files of a sequence were like when they were looked at last.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "core/hash.h"

namespace afterglow {

/// A hash a file, and hashes of parts of the row in logarithmic time: thousands of frames may look back to thousands.
class SequenceStamps {
 public:
  explicit SequenceStamps(std::size_t files);

  /// Zero: it is not there.
  void set(std::size_t file, const Hash& stamp);
  /// One hash of the files from `begin` to before `end`; those that were never set are by `look`. None: one of them is
  /// not there.
  std::optional<Hash> of(std::size_t begin, std::size_t end, const std::function<Hash(std::size_t file)>& look);

 private:
  Hash sum_before(std::size_t end) const;
  std::vector<Hash> stamps_;
  std::vector<Hash> sums_;  ///< a Fenwick tree of `stamps_`, whose halves are added each by itself
  std::set<std::size_t> unset_, gone_;
};

}  // namespace afterglow
