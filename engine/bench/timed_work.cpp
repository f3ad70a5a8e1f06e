#include "bench/timed_work.h"

#include <chrono>

namespace afterglow::bench {

Result<TimedWork> TimedWork::create(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  TimedWork out;
  AFTERGLOW_TRY(out.submitter_, Submitter::create(device));
  AFTERGLOW_CHECK(out.submitter_.record(record));
  return out;
}

Result<double> TimedWork::run() {
  const auto start = std::chrono::steady_clock::now();
  AFTERGLOW_CHECK(submitter_.submit_again());
  AFTERGLOW_CHECK(submitter_.wait());
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

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
