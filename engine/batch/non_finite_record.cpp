// SPDX-License-Identifier: MIT
#include "batch/non_finite_record.h"

#include <fmt/format.h>

#include "core/text.h"

namespace afterglow {
void take_findings(FrameNonFinite& frame, const Trace& trace, const Picture& picture) {
  frame.passes = trace.passes;
  frame.overflows = trace.overflows;
  set_places(frame.passes, picture);
}

Error non_finite_error(const PassFinding& finding, const std::filesystem::path& input) {
  return {ErrorKind::script, fmt::format("{}, in {} (--nan-policy fail)", finding_text(finding), input.string()),
          finding.file, finding.line};
}

void NonFiniteRecord::add(const FrameNonFinite& frame) {
  ++of_;
  for (const auto& [layer, found] : frame.input) samples_["input " + layer] += found.count();
  for (const auto& pass : frame.passes) samples_["pass " + pass.pass] += pass.found.count();
  if (!frame.input.empty() || !frame.passes.empty()) ++frames_;
}

void NonFiniteRecord::tell(const FrameNonFinite& frame, const std::filesystem::path& input, NanPolicy policy,
                           Diagnostics& diagnostics) const {
  const char* mended = policy == NanPolicy::neighbour ? "replaced by the mean of neighbours" : "replaced by 0";
  for (const auto& finding : frame.passes) {
    const std::string where = finding.file.empty() ? "" : fmt::format("{}:{}: ", finding.file, finding.line);
    diagnostics.warn_once("not finite: " + finding.pass,
                          fmt::format("{}{}; {}, in {}", where, finding_text(finding), mended, input.string()));
  }
  if (frame.untraced) diagnostics.warn_once("not finite, untraced", fmt::format("{}: {}", input.string(), kUntraced));
}

void NonFiniteRecord::tell_overflows(const FrameNonFinite& frame, const std::filesystem::path& input,
                                     Diagnostics& diagnostics) const {
  for (const auto& overflow : frame.overflows)
    diagnostics.warn_once(
        "overflow: " + overflow.pass,
        fmt::format("{}: pass '{}' overflows half floats: {} samples above 65504, first at {}; the frame was made "
                    "again in full floats",
                    input.string(), overflow.pass, overflow.samples, overflow.first.text()));
}

void NonFiniteRecord::sum_up(Diagnostics& diagnostics) const {
  if (frames_ == 0) return;
  std::vector<std::string> parts;
  for (const auto& [source, samples] : samples_) parts.push_back(fmt::format("{} from {}", samples, source));
  diagnostics.warn(fmt::format("samples that were not finite, in {} of {} frames: {}", frames_, of_, join(parts)));
}

}  // namespace afterglow
