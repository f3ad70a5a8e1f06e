// SPDX-License-Identifier: MIT
// One programme on one device, from the names of effects and presets to its report, and what else can be asked of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "stress/report.h"

namespace afterglow::stress {

struct StressRequest {
  std::vector<std::string> presets, effects;  ///< neither: every effect there is
  std::vector<std::filesystem::path> paths;
  DeviceOptions device;
  std::filesystem::path cache_folder;
  std::uint64_t seed = 1;
  std::uint64_t cases = 0;             ///< end after so many; 0: no such end
  std::optional<std::uint64_t> trial;  ///< the trial of this number alone
  double seconds = 0;                  ///< end after so long; 0: no such end
  bool brief = false;                  ///< kBriefCases, and less of the growth of errors
  std::filesystem::path out;           ///< folder for cases that fail
};
inline constexpr std::uint64_t kBriefCases = 1500;

struct StressEvents {
  std::function<void(const Summary&, std::size_t done, std::size_t total)> progress;
  std::function<void(const Finding&)> found;
  std::function<bool()> interrupted;
};

/// Tries everything, then asks other processes of this program for the same pixels and measures how errors grow.
/// Errors: script, usage, device (also what the validation layer says), io.
Result<StressReport> run_stress(const StressRequest& request, Diagnostics& diagnostics, const StressEvents& events);

/// A case that was kept, again.
struct Repeated {
  std::string check;
  Outcome outcome;
};
Result<Repeated> repeat_case(const std::filesystem::path& folder, const StressRequest& request,
                             Diagnostics& diagnostics);

/// What another process is asked for: digests of the results of trials, as text.
Result<std::string> digests_of(const std::vector<std::uint64_t>& trials, const StressRequest& request,
                               Diagnostics& diagnostics);

}  // namespace afterglow::stress
