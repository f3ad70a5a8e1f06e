// SPDX-License-Identifier: MIT
#include "apps/explain_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/graph_view.h"
#include "apps/setting_text.h"
#include "apps/space_text.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/key_finder.h"
#include "core/table.h"
#include "core/text.h"

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

std::string position_text(const Position& p) {
  return fmt::format("{{{}, {}, {}}}", number_text(p[0]), number_text(p[1]), number_text(p[2]));
}

bool shown(const std::string& wanted, const std::string& name) { return wanted.empty() || wanted == name; }

const std::string* skip_reason(const Look& look, const std::string& entry) {
  const auto found = std::ranges::find(look.build.graph.skipped, entry, &Skipped::name);
  return found == look.build.graph.skipped.end() ? nullptr : &found->reason;
}

// What became of a pass.
struct PassFate {
  const Pass* pass;
  const char* state;  ///< "runs", "fused", "skipped"
  std::string kernel, reason;
  bool once = false;    // it runs when its values change, not in every frame
  bool moving = false;  // as they do from this frame to the next
};

std::vector<PassFate> fates_of(const ExplainView& view, const std::string& entry) {
  const Look& look = view.look;
  std::vector<PassFate> fates;
  for (std::size_t i = 0; i < look.build.graph.passes.size(); ++i) {
    const Pass& pass = look.build.graph.passes[i];
    if (pass.effect != entry) continue;
    const int kernel = kernel_of(look.plan, static_cast<int>(i));
    if (kernel < 0) {
      const auto skipped = std::ranges::find(look.plan.skipped, pass.name, &Skipped::name);
      fates.push_back({&pass, "skipped", "", skipped == look.plan.skipped.end() ? "" : skipped->reason});
      continue;
    }
    const PlanKernel& runs = look.plan.kernels[static_cast<std::size_t>(kernel)];
    const bool first = runs.passes.front() == static_cast<int>(i);
    fates.push_back({&pass, first ? "runs" : "fused", runs.name, first ? "" : kFusionReason,
                     static_cast<bool>(look.plan.once[static_cast<std::size_t>(kernel)]),
                     view.moving.contains(pass.name)});
  }
  return fates;
}

std::string fate_text(const Look& look, const PassFate& fate) {
  if (fate.kernel.empty()) return "skipped: " + fate.reason;
  const std::string what = fmt::format("{} {}", info_of(fate.pass->kind).name, size_text(look.build.graph, *fate.pass));
  const std::string often = !fate.once    ? ""
                            : fate.moving ? ", once, and again in each frame: its values change with the frame"
                                          : ", once: it depends on settings and size alone";
  if (std::string_view(fate.state) == "fused") return fmt::format("{}, fused into {}", what, fate.kernel);
  return fate.kernel == fate.pass->name ? what + ", runs" + often
                                        : fmt::format("{}, runs as {}{}", what, fate.kernel, often);
}

std::string volume_steps(const SettingHistory& setting) {
  std::string out;
  for (const auto& step : setting.volumes)
    out += fmt::format("{}{}: {} × {} → {}", out.empty() ? "" : "; ", step.volume, step.value.text(),
                       number_text(step.factor), step.result.text());
  return out;
}

/// With the place where the value stands, when that is another script than the entry's.
std::string preset_text(const SettingHistory& setting, const StackEntry& entry) {
  if (!setting.preset) return "";
  std::string place;
  if (setting.place && setting.place->file != entry.file) {
    constexpr std::size_t kLargestScript = 1u << 20;
    const auto text = read_file(setting.place->file, kLargestScript);
    const int call = setting.place->line;
    const int line = text ? line_of_key(*text, call, "extend", {entry.name, setting.name}) : call;
    place = fmt::format("{}:{}", setting.place->file, line);
  }
  const std::string kind = setting.kind == "fixed" ? "" : setting.kind;
  const std::string more = kind + (kind.empty() || place.empty() ? "" : ", ") + place;
  return setting.preset->text() + (more.empty() ? "" : " (" + more + ")");
}

std::string history_text(const Graph& graph, const History& history) {
  const Size size = graph.images[static_cast<std::size_t>(history.previous)].size;
  const std::string first = history.first != kNoImage
                                ? graph.images[static_cast<std::size_t>(history.first)].name
                                : fmt::format("{{{}, {}, {}, {}}}", history.initial[0], history.initial[1],
                                              history.initial[2], history.initial[3]);
  return fmt::format("   history {}: {}×{}, keeps {}; without a frame before it: {}; pre-roll {} frames\n",
                     history.name, size.width, size.height, graph.images[static_cast<std::size_t>(history.next)].name,
                     first, history.pre_roll);
}

std::string entry_text(const ExplainView& view, const StackEntry& entry, const EntryHistory& history,
                       std::size_t place) {
  const auto* reason = skip_reason(view.look, entry.name);
  std::string out = fmt::format("\n{}. {}  at {}, order {}; {}{}: {}\n", place, entry.name, entry.at, entry.order,
                                space_text(view.look.spaces[place - 1]), composition_text(entry),
                                reason ? "skipped, " + *reason : "runs");
  if (const auto& warning = view.look.spaces[place - 1].warning; !warning.empty())
    out += fmt::format("   warning: {}\n", warning);
  Table settings({"setting", "default", "preset", "volumes", "--set", "final"});
  bool any = false;
  const auto add = [&](const std::vector<SettingHistory>& list, bool all) {
    for (const auto& setting : list) {
      if (!(view.setting.empty() ? all || is_said(setting) : shown(view.setting, setting.name))) continue;
      any = true;
      settings.add({setting.name, setting.default_value.text(), preset_text(setting, entry), volume_steps(setting),
                    setting.overridden ? setting.overridden->text() : "", setting.value.text()});
    }
  };
  add(history.settings, true);
  if (entry.mask && shown(view.setting, "mask")) {
    any = true;
    const bool replaced = history.preset_mask != entry.mask->text();
    settings.add(
        {"mask", "everywhere", history.preset_mask, "", replaced ? entry.mask->text() : "", entry.mask->text()});
  }
  add(history.composition, false);
  if (any) out += settings.text("   ");
  if (view.setting.empty())
    for (const auto& kept : view.look.build.graph.histories)
      if (kept.effect == entry.name) out += history_text(view.look.build.graph, kept);
  Table passes({"pass", ""});
  const auto fates = fates_of(view, entry.name);
  for (const auto& fate : fates) passes.add({fate.pass->name, fate_text(view.look, fate)});
  return fates.empty() || !view.setting.empty() ? out : out + passes.text("   ");
}

}  // namespace

std::string explain_text(const ExplainView& view) {
  const Explanation& explanation = *view.look.build.explanation;
  std::string out =
      fmt::format("{}: {}, frame {} ({} s)", view.file, view.look.preset->name(), number_text(view.context.frame),
                  number_text(std::round(view.context.time * 1e4) / 1e4));
  if (explanation.position)
    out += fmt::format(", seen from {} ({})", position_text(*explanation.position), explanation.position_from);
  out += "\n";
  if (!explanation.volumes.empty()) {
    Table table({"volume", "priority", "weight", "distance", "factor", ""});
    for (const auto& volume : explanation.volumes)
      table.add({volume.name, number_text(volume.priority), number_text(volume.weight),
                 volume.distance ? number_text(*volume.distance) : "", number_text(volume.factor), volume.reason});
    out += "\n" + table.text();
  }
  const auto& entries = *view.look.build.entries;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (shown(view.entry, entries[i].name)) out += entry_text(view, entries[i], explanation.entries[i], i + 1);
  return out;
}

std::string explain_json(const ExplainView& view) {
  const Explanation& explanation = *view.look.build.explanation;
  Json out{{"file", view.file},
           {"name", view.look.preset->name()},
           {"frame", view.context.frame},
           {"time", view.context.time},
           {"fps", view.context.fps}};
  add_volumes(out, explanation);
  out["entries"] = Json::array();
  const auto& entries = *view.look.build.entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!shown(view.entry, entries[i].name)) continue;
    Json item = entry_json(entries[i], view.look.build.graph.skipped);
    item["light"] = space_json(view.look.spaces[i]);
    add_composition(item, entries[i], explanation.entries[i]);
    item["settings"] = Json::array();
    for (const auto& setting : explanation.entries[i].settings)
      if (shown(view.setting, setting.name)) item["settings"].push_back(history_json(setting));
    item["passes"] = Json::array();
    for (const auto& fate : fates_of(view, entries[i].name)) {
      Json pass{{"name", fate.pass->name}, {"state", fate.state}};
      if (!fate.kernel.empty()) pass["kernel"] = fate.kernel;
      if (!fate.reason.empty()) pass["reason"] = fate.reason;
      if (fate.once) pass["once"] = true;
      if (fate.once && fate.moving) pass["again_in_each_frame"] = true;
      item["passes"].push_back(std::move(pass));
    }
    for (const auto& history : view.look.build.graph.histories)
      if (history.effect == entries[i].name)
        item["histories"].push_back({{"name", history.name}, {"pre_roll", history.pre_roll}});
    out["entries"].push_back(std::move(item));
  }
  return json_text(out);
}

}  // namespace afterglow
