// SPDX-License-Identifier: MIT
#include "bench/turns.h"

namespace afterglow::bench {

Result<std::vector<Spread>> run_in_turns(const std::vector<Measured>& all, int repeat,
                                         const std::function<Result<void>(int round)>& step) {
  std::vector<std::vector<double>> samples(all.size());
  for (int round = 0; round <= repeat; ++round) {
    AFTERGLOW_CHECK(step(round));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t at = (i + static_cast<std::size_t>(round)) % all.size();
      AFTERGLOW_TRY(const double time, all[at]());
      if (round > 0) samples[at].push_back(time);
    }
  }
  std::vector<Spread> out;
  for (auto& one : samples) out.push_back(Spread::of(std::move(one)));
  return out;
}

}  // namespace afterglow::bench
