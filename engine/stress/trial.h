// SPDX-License-Identifier: MIT
// What is tried, one after the other: made from a seed and a number alone, so that any of it can be made again.
#pragma once

#include <string>
#include <vector>

#include "script/preset.h"
#include "stress/check.h"

namespace afterglow::stress {

/// What the programme tries: effects one by one, presets whole.
struct Subject {
  std::string name;
  std::vector<Look> looks;                  ///< settings to try, the defaults first; after them come random ones
  std::optional<EffectSchema> effect;       ///< of a single effect: what random settings are drawn for
  std::vector<EffectSchema> composed = {};  ///< effects that random stacks with groups are made of
  std::vector<EffectSchema> masks = {};     ///< what these are masked by
};

/// A look on some pictures of one size.
struct Trial {
  std::uint64_t index = 0;
  std::string subject;
  Look look;
  Size size;
  double frame = 1;
  std::vector<PictureSpec> pictures;
  std::uint64_t seed = 0;  ///< of the checks
};

class Trials {
 public:
  Trials(std::vector<Subject> subjects, SearchPath path, std::uint64_t seed)
      : subjects_(std::move(subjects)), path_(std::move(path)), seed_(seed) {}
  /// Subjects take turns; each goes through its looks in order, then through random ones without end.
  Trial at(std::uint64_t index) const;
  const std::vector<Subject>& subjects() const { return subjects_; }
  /// Until every subject has had all of its looks.
  std::uint64_t round() const;

 private:
  std::vector<Subject> subjects_;
  SearchPath path_;
  std::uint64_t seed_;
};

/// Every effect on the path, each by itself, and "composition": random stacks of them with groups; or those of these
/// names; "mask.NAME" is compositions with that mask alone. Errors: usage (unknown name), script.
Result<std::vector<Subject>> subjects_of_effects(const std::vector<std::string>& names,
                                                 const std::vector<std::filesystem::path>& paths,
                                                 Diagnostics& diagnostics);

}  // namespace afterglow::stress
