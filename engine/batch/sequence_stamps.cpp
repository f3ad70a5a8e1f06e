// SPDX-License-Identifier: MIT
#include "batch/sequence_stamps.h"

namespace afterglow {
namespace {

Hash sum(const Hash& a, const Hash& b) { return {a.high + b.high, a.low + b.low}; }
Hash difference(const Hash& a, const Hash& b) { return {a.high - b.high, a.low - b.low}; }
std::size_t lowest_bit(std::size_t number) { return number & (~number + 1); }

}  // namespace

SequenceStamps::SequenceStamps(std::size_t files) : stamps_(files), sums_(files) {
  for (std::size_t file = 0; file < files; ++file) unset_.insert(unset_.end(), file);
}

void SequenceStamps::set(std::size_t file, const Hash& stamp) {
  unset_.erase(file);
  if (stamp == Hash{}) {
    gone_.insert(file);
  } else {
    gone_.erase(file);
  }
  const Hash change = difference(stamp, stamps_[file]);
  stamps_[file] = stamp;
  for (std::size_t at = file + 1; at <= sums_.size(); at += lowest_bit(at)) sums_[at - 1] = sum(sums_[at - 1], change);
}

Hash SequenceStamps::sum_before(std::size_t end) const {
  Hash out;
  for (std::size_t at = end; at > 0; at -= lowest_bit(at)) out = sum(out, sums_[at - 1]);
  return out;
}

std::optional<Hash> SequenceStamps::of(std::size_t begin, std::size_t end,
                                       const std::function<Hash(std::size_t file)>& look) {
  for (auto at = unset_.lower_bound(begin); at != unset_.end() && *at < end; at = unset_.lower_bound(begin))
    set(*at, look(*at));
  if (const auto gone = gone_.lower_bound(begin); gone != gone_.end() && *gone < end) return std::nullopt;
  return difference(sum_before(end), sum_before(begin));
}

}  // namespace afterglow
