// SPDX-License-Identifier: MIT
#include <algorithm>
#include <tuple>

#include "shader/kernel.h"

namespace afterglow {
namespace {

bool same_stage(const KernelStage& a, const KernelStage& b) {
  const auto all = [](const KernelStage& s) {
    return std::tie(s.shader, s.constants, s.straight, s.lights_black, s.color, s.values, s.again, s.channels);
  };
  return all(a) == all(b);
}

}  // namespace

bool same_kernel(const KernelDesc& a, const KernelDesc& b) {
  const auto rest = [](const KernelDesc& k) {
    return std::tie(k.filter, k.ratio_x, k.ratio_y, k.filter_channels, k.config, k.target, k.target_channels,
                    k.finite_check, k.reads);
  };
  return rest(a) == rest(b) && a.sample.has_value() == b.sample.has_value() &&
         (!a.sample || same_stage(*a.sample, *b.sample)) && std::ranges::equal(a.stages, b.stages, same_stage);
}

}  // namespace afterglow
