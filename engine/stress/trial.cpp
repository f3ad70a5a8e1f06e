// SPDX-License-Identifier: MIT
#include "stress/trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "reference/stack.h"
#include "stress/settings.h"

namespace afterglow::stress {
namespace {

constexpr int kPicturesPerTrial = 3;
constexpr const char* kComposition = "composition";
const std::string kOfMasks = "mask.";

/// Small ones come often: they are quick, and hold as many edges.
Size random_size(Random& random) {
  static const std::vector<Size> kSmall{{1, 1},   {1, 2},   {2, 1},  {2, 2},   {3, 3},   {5, 3},   {1, 17},
                                        {23, 1},  {7, 11},  {8, 8},  {13, 17}, {16, 16}, {31, 37}, {32, 32},
                                        {64, 64}, {33, 65}, {17, 5}, {9, 64},  {63, 62}, {48, 20}};
  static const std::vector<Size> kMiddle{{128, 128}, {101, 57}, {97, 61}, {240, 135}, {128, 64}, {256, 256}, {160, 90}};
  static const std::vector<Size> kLong{{1, 4099}, {4099, 1}, {16384, 2}, {2, 16384}, {1021, 7}};
  const double kind = random.unit();
  return random.pick(kind < 0.62 ? kSmall : kind < 0.95 ? kMiddle : kLong);
}

}  // namespace

std::uint64_t Trials::round() const {
  std::size_t most = 0;
  for (const auto& subject : subjects_) most = std::max(most, subject.looks.size());
  return most * subjects_.size();
}

Trial Trials::at(std::uint64_t index) const {
  const Subject& subject = subjects_[index % subjects_.size()];
  const std::uint64_t turn = index / subjects_.size();
  Random random(seed_, index);
  Trial trial{.index = index, .subject = subject.name, .look = subject.looks.front()};
  if (turn < subject.looks.size())
    trial.look = subject.looks[turn];
  else if (subject.effect)
    trial.look.entries = {random_entry(*subject.effect, path_, random)};
  else if (!subject.composed.empty())
    trial.look.entries = random_composition(subject.composed, subject.masks, path_, random);
  trial.size = random_size(random);
  trial.frame = random.chance(0.5) ? 1 : random.between(2, 5000);
  const auto kinds = picture_kinds();
  // One kind after the other, so that each subject meets them all; the rest by chance.
  for (int i = 0; i < kPicturesPerTrial; ++i) {
    const std::size_t kind = i == 0 ? (turn + index) % kinds.size() : random.below(kinds.size());
    trial.pictures.push_back({kinds[kind].name, trial.size, random.next()});
  }
  trial.seed = random.next();
  return trial;
}

namespace {

/// A promise that nothing can be held to.
void warn_without_oracle(const EffectSchema& effect, Diagnostics& diagnostics) {
  const auto of_error = [](const InvariantSchema& hold) { return hold.stated.name == "error"; };
  if (std::ranges::none_of(effect.invariants, of_error)) return;
  if (reference::has_oracle(effect.name)) return;
  diagnostics.warn(fmt::format(
      "effect '{}' promises an error (`holds`), but there is no oracle of it: nothing checks that", effect.name));
}

}  // namespace

Result<std::vector<Subject>> subjects_of_effects(const std::vector<std::string>& names,
                                                 const std::vector<std::filesystem::path>& paths,
                                                 Diagnostics& diagnostics) {
  const SearchPath path = search_path_for({}, paths);
  AFTERGLOW_TRY(auto effects, list_effects(path, diagnostics));
  AFTERGLOW_TRY(auto masks, list_masks(path, diagnostics));
  std::vector<std::string> known;
  for (const auto& effect : effects) known.push_back(effect.name);
  known.emplace_back(kComposition);
  for (const auto& mask : masks) known.push_back(kOfMasks + mask.name);
  for (const auto& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    if (auto error = effect_error(path, name)) return *std::move(error);
    return Error{ErrorKind::usage,
                 fmt::format("unknown effect '{}'", name),
                 {},
                 0,
                 join(known) + "; effects of yours with --path FOLDER (--path . for this one's)",
                 nearest_name(name, known)};
  }
  const auto wanted = [&](const std::string& name) {
    return names.empty() || std::ranges::find(names, name) != names.end();
  };
  std::vector<Subject> out;
  for (const auto& effect : effects) {
    if (!wanted(effect.name)) continue;
    if (!names.empty()) warn_without_oracle(effect, diagnostics);
    Subject subject{.name = effect.name, .looks = {}, .effect = {}};
    for (auto& entry : hard_entries(effect, path)) subject.looks.push_back({{std::move(entry)}, paths});
    subject.effect = effect;
    out.push_back(std::move(subject));
  }
  const auto add_composition = [&](const std::string& name, const std::vector<EffectSchema>& by) {
    out.push_back({.name = name, .looks = {{{}, paths}}, .effect = {}, .composed = effects, .masks = by});
  };
  if (wanted(kComposition)) add_composition(kComposition, masks);
  for (const auto& mask : masks)  // without names they are part of the composition
    if (!names.empty() && wanted(kOfMasks + mask.name)) add_composition(kOfMasks + mask.name, {mask});
  return out;
}

}  // namespace afterglow::stress
