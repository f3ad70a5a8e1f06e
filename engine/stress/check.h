// SPDX-License-Identifier: MIT
// What is checked: invariants of every stack, and what effects promise (`holds`, script/schema.h).
#pragma once

#include <optional>
#include <span>
#include <string>

#include "stress/harness.h"
#include "stress/look.h"
#include "stress/pictures.h"

namespace afterglow::stress {

/// All that decides the outcome of a check. A smaller one is one with fewer pixels, settings, entries.
struct Situation {
  Look look;
  Picture picture;
  double frame = 1;
  std::string check;
  std::uint64_t seed = 0;  ///< what the check itself chooses by chance: rectangles, ways, other pictures
};

struct Outcome {
  bool applies = true;  ///< false: the check says nothing about this situation
  bool holds = true;
  double measured = 0;  ///< in the measure of the check: error, gain, number of samples
  double allowed = 0;
  std::string what;  ///< of one that does not hold: what was seen, where
};

struct Check {
  const char* name;
  const char* promise;  ///< the effect's promise that it checks; null: every stack must stand it
  const char* doc;
  Result<Outcome> (*run)(Harness& harness, const Situation& situation, const Invariant& hold);
  long long most_pixels = 1 << 24;  ///< it runs the stack so often that larger pictures would take too long
};

std::span<const Check> checks();
/// Null when there is none of that name.
const Check* find_check(const std::string& name);

/// Runs the check that the situation names. A promise that does not hold for these settings does not apply. Errors:
/// those of Harness; a script that refuses the settings does not apply either.
Result<Outcome> run_check(Harness& harness, const Situation& situation);

// For the files that hold checks.

std::span<const Check> common_checks();      ///< checks_common.cpp
std::span<const Check> light_checks();       ///< checks_light.cpp
std::span<const Check> continuous_checks();  ///< check_continuous.cpp
std::span<const Check> symmetry_checks();    ///< checks_symmetry.cpp
std::span<const Check> exact_checks();       ///< check_error.cpp

inline Outcome not_applicable() { return {.applies = false}; }
inline Outcome within_bound(double measured, double allowed, const std::string& what) {
  const bool holds = measured <= allowed;
  return {.holds = holds, .measured = measured, .allowed = allowed, .what = holds ? std::string() : what};
}
/// A copy to change: nothing that is known of the pixels stays.
inline Picture changed(const Picture& picture) {
  Picture out = picture;
  out.content.clear();
  return out;
}
/// The situation's picture without colour: each pixel as bright as its brightest channel.
Picture greys_of(const Situation& situation);
/// The usual way of execution, in full floats.
Way usual_way(const Harness& harness);
/// What an error is divided by: the sample that was wanted (docs/math.md §13), or the largest of its pixel's R, G and
/// B. Colours are mixed by matrices, where a small channel is the difference of large ones: two ways of adding them are
/// equally good when they differ by the last digits of the large ones.
enum class MeasuredBy { sample, pixel };
/// Compares R, G and B. `allowed` 0: bit for bit, alpha too.
Outcome compare(const Image& a, const Image& wanted, double allowed, const std::string& what,
                MeasuredBy by = MeasuredBy::sample);
/// "pixel 3 4 green".
std::string place_of(const Image& image, std::size_t sample);

}  // namespace afterglow::stress
