// SPDX-License-Identifier: MIT
#include "stress/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "image/metrics.h"

namespace afterglow::stress {
namespace {

const Invariant kNoInvariant;

Outcome compare_bits(const Image& a, const Image& wanted, const std::string& what) {
  std::size_t different = 0, first = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (std::bit_cast<std::uint32_t>(a.pixels[i]) != std::bit_cast<std::uint32_t>(wanted.pixels[i]) && different++ == 0)
      first = i;
  if (different == 0) return {};
  return {.holds = false,
          .measured = static_cast<double>(different),
          .allowed = 0,
          .what = fmt::format("{}: {} of {} samples differ, first {}: {:.9g}, expected {:.9g}", what, different,
                              a.pixels.size(), place_of(a, first), a.pixels[first], wanted.pixels[first])};
}

std::vector<float> rgb_of(const Image& image) {
  std::vector<float> out;
  out.reserve(image.pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    out.insert(out.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(i),
               image.pixels.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  return out;
}

/// Of each sample of rgb_of: the largest channel of its pixel.
std::vector<float> largest_of(const std::vector<float>& rgb) {
  std::vector<float> out(rgb.size());
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(i), 3,
                std::max({std::abs(rgb[i]), std::abs(rgb[i + 1]), std::abs(rgb[i + 2])}));
  return out;
}

}  // namespace

std::string place_of(const Image& image, std::size_t sample) {
  static constexpr const char* kNames[] = {"red", "green", "blue", "alpha"};
  const auto pixel = static_cast<int>(sample / static_cast<std::size_t>(image.channels));
  return fmt::format("pixel {} {} {}", pixel % image.width, pixel / image.width,
                     kNames[sample % static_cast<std::size_t>(image.channels)]);
}

Way usual_way(const Harness& harness) { return {.choice = harness.usual()}; }

Outcome compare(const Image& a, const Image& wanted, double allowed, const std::string& what, MeasuredBy by) {
  if (a.size() != wanted.size()) return {.holds = false, .measured = 1, .allowed = 0, .what = what + ": sizes differ"};
  if (allowed <= 0) return compare_bits(a, wanted, what);
  const auto x = rgb_of(a), y = rgb_of(wanted);
  const ErrorMeasure error = measure_error(x, y, by == MeasuredBy::pixel ? largest_of(y) : y);
  const bool holds = within(error, allowed);
  const std::size_t sample = error.worst_index / 3 * 4 + error.worst_index % 3;
  Outcome out{.holds = holds, .measured = std::max(error.percentile, error.worst / 50), .allowed = allowed, .what = {}};
  if (!holds)
    out.what = fmt::format("{}: error {:.3g} (99.99 %), {:.3g} (worst, {}: {:.9g}, expected {:.9g}), allowed {:.3g}",
                           what, error.percentile, error.worst, place_of(a, sample), a.pixels[sample],
                           wanted.pixels[sample], allowed);
  return out;
}

std::span<const Check> checks() {
  static const std::vector<Check> all = [] {
    std::vector<Check> list;
    for (const auto part : {common_checks(), light_checks(), continuous_checks(), symmetry_checks(), exact_checks()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

const Check* find_check(const std::string& name) {
  const auto found = std::ranges::find_if(checks(), [&](const Check& check) { return name == check.name; });
  return found == checks().end() ? nullptr : &*found;
}

Result<Outcome> run_check(Harness& harness, const Situation& situation) {
  const Check& check = *find_check(situation.check);
  if (situation.picture.color.size().area() > check.most_pixels) return not_applicable();
  const auto facts = harness.facts(situation.look, situation.picture.color.size(), situation.frame);
  if (!facts) return not_applicable();
  if (!check.promise) return check.run(harness, situation, kNoInvariant);
  const auto hold = std::ranges::find(facts->invariants, check.promise, &Invariant::name);
  if (hold == facts->invariants.end()) return not_applicable();
  return check.run(harness, situation, *hold);
}

}  // namespace afterglow::stress
