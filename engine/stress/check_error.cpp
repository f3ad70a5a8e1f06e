// SPDX-License-Identifier: MIT
// The promise about the error against double precision.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stress/check.h"
#include "stress/truth.h"

namespace afterglow::stress {
namespace {

Outcome against_truth(const Image& image, const std::vector<double>& truth, double allowed, bool half, const Way& way) {
  const ErrorMeasure error = error_against(image, truth, half);
  const std::size_t sample = error.worst_index / 3 * 4 + error.worst_index % 3;
  Outcome out{.holds = within(error, allowed),
              .measured = std::max(error.percentile, error.worst / 50),
              .allowed = allowed,
              .what = {}};
  if (!out.holds)
    out.what = fmt::format(
        "{}: error {:.3g} (99.99 %), {:.3g} (worst, {}: {:.9g}, in double precision {:.9g}), allowed {:.3g}",
        way.name(), error.percentile, error.worst, place_of(image, sample), image.pixels[sample],
        truth[error.worst_index], allowed);
  return out;
}

Result<Outcome> check_error(Harness& harness, const Situation& s, const Invariant& hold, bool half) {
  const float largest = *std::ranges::max_element(s.picture.color.pixels);
  if (!std::isfinite(hold.numbers.at(half ? "fp16" : "fp32"))) return not_applicable();
  if (largest > hold.numbers.at("up_to") || (half && !exact_in_halves(s.picture.color))) return not_applicable();
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  const auto truth = truth_of(facts, s.picture, s.frame);
  if (!truth) return not_applicable();
  const double allowed = hold.numbers.at(half ? "fp16" : "fp32");
  Way way = usual_way(harness);
  if (half) way.choice.storage = Storage::fp16;
  AFTERGLOW_TRY(const Made made, harness.run(s.look, s.picture, s.frame, way));
  return against_truth(made.image, *truth, allowed, half, way);
}

Result<Outcome> error_fp32(Harness& harness, const Situation& s, const Invariant& hold) {
  return check_error(harness, s, hold, false);
}
Result<Outcome> error_fp16(Harness& harness, const Situation& s, const Invariant& hold) {
  return check_error(harness, s, hold, true);
}

/// Faded, blended and masked effects and groups of them, as far as each promises its error.
Result<Outcome> composed(Harness& harness, const Situation& s, const Invariant&) {
  constexpr float kBrightest = 8;   // screens and overlays of brighter light are differences of large numbers
  constexpr double kMasked = 2e-5;  // masks and blends themselves
  if (!s.look.is_composed() || *std::ranges::max_element(s.picture.color.pixels) > kBrightest) return not_applicable();
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  const auto truth = facts.error && facts.runs ? truth_of(facts, s.picture, s.frame) : std::nullopt;
  if (!truth) return not_applicable();
  const Way way = usual_way(harness);
  AFTERGLOW_TRY(const Made made, harness.run(s.look, s.picture, s.frame, way));
  return against_truth(made.image, *truth, *facts.error + kMasked, false, way);
}

constexpr long long kLargeForOracle = 1 << 17;

constexpr Check kExactChecks[] = {
    {"error_fp32", "error", "the error against double precision, in full floats", error_fp32, kLargeForOracle},
    {"error_fp16", "error", "the same with images in half floats", error_fp16, kLargeForOracle},
    {"error_composed", nullptr, "opacity, blend, masks and groups: the error against double precision", composed,
     kLargeForOracle},
};

}  // namespace

std::span<const Check> exact_checks() { return kExactChecks; }

}  // namespace afterglow::stress
