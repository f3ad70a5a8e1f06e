// SPDX-License-Identifier: MIT
#include "image/choice_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::size_t kNamed = 6;  ///< names in a message

/// As it has to be typed.
std::string typed(const std::string& name) {
  static constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-/:@%+";
  if (name.find_first_not_of(kPlain) == std::string::npos) return name;
  return "'" + name + "'";
}

std::string quoted(std::vector<std::string> names) {
  const bool cut = names.size() > kNamed;
  if (cut) names.resize(kNamed);
  for (std::string& name : names) name = "'" + name + "'";
  return join(names) + (cut ? ", …" : "");
}

/// What an option has to say for a choice: the file, where it is another, and the name.
std::string option_text(const AuxiliaryPlan& plan, const std::string& name) {
  return typed(plan.other ? plan.other->path().string() + ":" + name : name);
}

void report_equal(const ReadPlan& plan, const AuxiliaryPlan& extra, Diagnostics& diagnostics) {
  if (extra.choice.equal.empty() || !extra.kind) return;
  const auto& parts = plan.file_of(extra).parts();
  std::vector<std::string> names;
  for (const ChannelChoice& other : extra.choice.equal) names.push_back(choice_name(parts, other));
  diagnostics.warn_once(
      "equal " + extra.name,
      fmt::format("{}: {} is taken from '{}', the first in the file; {} would do as well; --{} {} takes {}",
                  plan.file_of(extra).path().string(), extra.name, choice_name(parts, extra.choice), quoted(names),
                  extra.name, option_text(extra, names.front()), names.size() > 1 ? "that" : "it"));
}

}  // namespace

std::map<std::string, std::string> taken_channels(const ReadPlan& plan, const std::vector<std::string>& wanted) {
  std::map<std::string, std::string> taken{{"color", choice_text(plan.file->parts(), plan.color)}};
  for (const AuxiliaryPlan& extra : plan.auxiliary) {
    if (std::ranges::find(wanted, extra.name) == wanted.end()) continue;
    std::string text = choice_text(plan.file_of(extra).parts(), extra.choice);
    if (extra.other) text += " of " + extra.other->path().string();
    taken[extra.name] = std::move(text);
  }
  return taken;
}

std::map<std::string, std::string> likely_channels(const ReadPlan& plan) {
  std::map<std::string, std::string> hints;
  for (const AuxiliaryKind* kind : kKinds) {
    if (std::ranges::find(plan.auxiliary, kind->name, &AuxiliaryPlan::name) != plan.auxiliary.end()) continue;
    const std::vector<std::string> names = likely_names(plan.file->parts(), kind->name);
    if (names.empty()) continue;
    hints[kind->name] = fmt::format("{} of the picture may be meant: --{} {} takes {}", quoted(names), kind->name,
                                    typed(names.front()), names.size() > 1 ? "the first" : "it");
  }
  return hints;
}

void report_choices(const ReadPlan& plan, const ReadOptions& options, Diagnostics& diagnostics) {
  const std::string file = plan.file->path().string();
  if (options.layer.empty())
    if (const auto equal = equal_colors(plan.file->parts()); !equal.empty())
      diagnostics.warn_once("layer taken", fmt::format("{}: '{}' is taken of the layers {}; --layer says another", file,
                                                       equal.front(), join(equal)));
  for (const AuxiliaryPlan& extra : plan.auxiliary) report_equal(plan, extra, diagnostics);
  // A picture that has one layer alone has nothing to tell.
  if (plan.auxiliary.empty() && layer_names(plan.file->parts()).size() < 2) return;
  std::vector<std::string> said;
  for (const auto& [name, text] : taken_channels(plan, options.auxiliary))
    if (!text.empty()) said.push_back(name + " " + text);
  const std::string text = "taken of the channels: " + join(said);
  diagnostics.note_once(text, fmt::format("{}: {}", file, text));
}

}  // namespace afterglow
