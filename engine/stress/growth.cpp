// SPDX-License-Identifier: MIT
#include "stress/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "stress/settings.h"
#include "stress/truth.h"

namespace afterglow::stress {
namespace {

/// The setting that counts levels, or null.
const SettingSchema* levels_of(const EffectSchema& effect) {
  for (const auto& hold : effect.invariants) {
    const auto named = hold.stated.settings.find("levels");
    if (named == hold.stated.settings.end()) continue;
    const auto found = std::ranges::find(effect.settings, named->second, &SettingSchema::name);
    if (found != effect.settings.end()) return &*found;
  }
  return nullptr;
}

struct Variant {
  std::string name;
  LookEntry entry;
};

/// The defaults, and each other choice by itself.
std::vector<Variant> variants_of(const EffectSchema& effect, const LookEntry& defaults, bool quick) {
  std::vector<Variant> out{{"defaults", defaults}};
  if (quick) return out;
  for (const auto& setting : effect.settings) {
    if (setting.type != SettingType::enumeration && setting.type != SettingType::boolean) continue;
    for (const auto& value : hard_values(setting)) {
      out.push_back({fmt::format("{} = {}", setting.name, value.text()), defaults});
      out.back().entry.set(setting.name, value);
    }
  }
  return out;
}

std::vector<std::string> kinds(bool quick) {
  if (quick) return {"render", "fireflies", "steps"};
  std::vector<std::string> out;
  for (const auto& kind : picture_kinds())
    if (kind.gentle && std::string(kind.name) != "black") out.emplace_back(kind.name);
  return out;
}

Result<std::optional<GrowthRow>> measure(Harness& harness, const Look& look, const Picture& picture) {
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(look, picture.color.size(), 1));
  const auto truth = truth_of(facts, picture, 1);
  if (!truth) return std::optional<GrowthRow>();
  GrowthRow row;
  Way way{.choice = harness.usual()};
  AFTERGLOW_TRY(const Made full, harness.run(look, picture, 1, way));
  row.fp32 = error_against(full.image, *truth, false);
  row.has_fp16 = exact_in_halves(picture.color);
  if (row.has_fp16) {
    way.choice.storage = Storage::fp16;
    AFTERGLOW_TRY(const Made half, harness.run(look, picture, 1, way));
    row.fp16 = error_against(half.image, *truth, true);
  }
  return std::optional(std::move(row));
}

/// What is the same for all pictures and numbers of levels.
struct Growing {
  const EffectSchema& effect;
  const SettingSchema& levels;
  const Variant& variant;
  std::vector<std::filesystem::path> paths;
};

Result<void> grow(Harness& harness, const Growing& what, const PictureSpec& spec, std::vector<GrowthRow>& rows) {
  const Picture picture = make_picture(spec);
  std::size_t passes = 0;
  const int most = static_cast<int>(what.levels.max.value_or(16));
  for (int levels = std::max(1, static_cast<int>(what.levels.min.value_or(1))); levels <= most; ++levels) {
    Look look{{what.variant.entry}, what.paths};
    look.entries.front().set(what.levels.name, {.type = SettingType::integer, .number = {double(levels), 0, 0}});
    AFTERGLOW_TRY(const LookFacts facts, harness.facts(look, spec.size, 1));
    if (facts.passes == passes) break;  // no level more
    passes = facts.passes;
    AFTERGLOW_TRY(auto row, measure(harness, look, picture));
    if (!row) return {};
    row->effect = what.effect.name;
    row->variant = what.variant.name;
    row->picture = spec.kind;
    row->levels = levels;
    rows.push_back(std::move(*row));
  }
  return {};
}

}  // namespace

Result<std::vector<GrowthRow>> error_growth(Harness& harness, const std::vector<Subject>& subjects, Size size,
                                            bool quick, std::uint64_t seed, const std::function<Result<void>()>& step) {
  std::vector<GrowthRow> rows;
  for (const auto& subject : subjects) {
    const SettingSchema* levels = subject.effect ? levels_of(*subject.effect) : nullptr;
    if (!levels) continue;
    for (const auto& variant : variants_of(*subject.effect, subject.looks.front().entries.front(), quick))
      for (const auto& kind : kinds(quick)) {
        AFTERGLOW_CHECK(step());
        harness.forget();
        AFTERGLOW_CHECK(
            grow(harness, {*subject.effect, *levels, variant, subject.looks.front().paths}, {kind, size, seed}, rows));
      }
  }
  return rows;
}

std::string growth_text(const std::vector<GrowthRow>& rows) {
  struct Worst {
    double fp32 = 0, fp16 = 0, worst32 = 0, worst16 = 0;
    std::string picture32, picture16;
  };
  std::map<std::pair<std::string, int>, Worst> all;
  for (const auto& row : rows) {
    Worst& worst = all[{row.effect, row.levels}];
    const std::string condition = row.variant == "defaults" ? row.picture : row.picture + ", " + row.variant;
    if (row.fp32.percentile >= worst.fp32) worst.fp32 = row.fp32.percentile, worst.picture32 = condition;
    if (row.has_fp16 && row.fp16.percentile >= worst.fp16)
      worst.fp16 = row.fp16.percentile, worst.picture16 = condition;
    worst.worst32 = std::max(worst.worst32, row.fp32.worst);
    if (row.has_fp16) worst.worst16 = std::max(worst.worst16, row.fp16.worst);
  }
  std::string out = fmt::format("{:<20}{:>7}  {:<10}{:<10}{:<10}{:<10}{}\n", "effect", "levels", "fp32", "worst",
                                "fp16", "worst", "where fp32 · fp16 are largest");
  for (const auto& [key, worst] : all)
    out += fmt::format("{:<20}{:>7}  {:<10.2g}{:<10.2g}{:<10.2g}{:<10.2g}{} · {}\n", key.first, key.second, worst.fp32,
                       worst.worst32, worst.fp16, worst.worst16, worst.picture32, worst.picture16);
  return out;
}

}  // namespace afterglow::stress
