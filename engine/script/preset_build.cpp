// SPDX-License-Identifier: MIT
// Preset: the graph of a frame.
#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "graph/difference.h"
#include "script/build.h"
#include "script/composite.h"
#include "script/graph_binding.h"
#include "script/injection.h"
#include "script/invariant_reader.h"
#include "script/preset_state.h"
#include "script/unread.h"

namespace afterglow {

namespace {

void warn_without_position(const Explanation& explanation, Diagnostics& diagnostics) {
  if (explanation.position) return;
  for (const auto& volume : explanation.volumes)
    if (!volume.reason.empty() && volume.weight > 0)
      diagnostics.warn_once("no position",
                            fmt::format("volume '{}' and others like it do not count: no position is "
                                        "known (--at, position in the preset, worldToCamera in the file)",
                                        volume.name));
}

// Channels that may be meant by inputs that are missing.
std::string hints_text(const std::vector<std::string>& missing, const BuildContext& context) {
  std::string text;
  for (const auto& name : missing)
    if (const auto hint = context.hints.find(name); hint != context.hints.end()) text += "; " + hint->second;
  return text;
}

// What layers there are, where one is missing.
std::string layers_text(const std::vector<std::string>& missing, const BuildContext& context) {
  constexpr std::size_t kMost = 20;
  for (const auto& name : missing) {
    if (!name.starts_with(kLayerPrefix)) continue;
    if (context.layers.empty()) return "; the picture has no named layers";
    std::vector<std::string> known = context.layers;
    const std::string wanted = name.substr(kLayerPrefix.size());
    const bool is_there = std::ranges::find(known, wanted) != known.end();
    const std::string nearest = is_there ? "" : nearest_name(wanted, known);
    if (known.size() > kMost) known.resize(kMost), known.emplace_back("…");
    return fmt::format("; the picture has the layers {}{}", join(known),
                       nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }
  return {};
}

void warn_skipped(const StackEntry& entry, const std::string& reason, Diagnostics& diagnostics) {
  diagnostics.warn_once(fmt::format("{}:{}: {}", entry.file, entry.name, reason),
                        fmt::format("effect '{}' is skipped: {}", entry.name, reason));
}

void skip(const StackEntry& entry, Inactive why, GraphBuilder& graph, Diagnostics& diagnostics) {
  if (why.told) warn_skipped(entry, why.reason, diagnostics);
  graph.add_skipped(entry.name, std::move(why.reason));
}

}  // namespace

ImageRef Preset::State::build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                                    Diagnostics& diagnostics) {
  const StackEntry& entry = run.entry;
  if (is_left_out(lua, run, graph, diagnostics)) return source;
  if (auto why = why_inactive(lua, run)) {
    skip(entry, std::move(*why), graph, diagnostics);
    return source;
  }
  const EffectSchema& effect = runtime->effects[static_cast<std::size_t>(run.effect)].schema;
  graph.begin(entry, used_inputs(lua, run), alpha == "associated" ? nullptr : &effect);
  const ImageRef image = run_build(lua, run, graph, source);
  graph.end();
  graph.tell_warnings(diagnostics);
  if (image.id == source.id) {
    graph.add_skipped(entry.name, graph.skip_reason().value_or("returned its source"));
    return image;
  }
  if (const auto warning = graph.fixed_alpha(image)) diagnostics.warn_once(*warning, *warning);
  // What an idle effect makes is its source; that over the source is made all the same.
  if (const auto limit = idle_limit(lua, run, source)) graph.add_idle(source, image, *limit);
  const ImageRef seen = composite(lua, run, graph, source, image);
  if (seen.id == source.id) graph.add_skipped(entry.name, "its mask selects nothing");
  return seen;
}

/// Disabled, unseen, or without an input that it needs; said why.
bool Preset::State::is_left_out(lua_State* lua, const EntryRun& run, GraphBuilder& graph, Diagnostics& diagnostics) {
  const StackEntry& entry = run.entry;
  if (!entry.enabled) {
    graph.add_skipped(entry.name, "disabled");
    return true;
  }
  if (auto why = why_unseen(lua, run)) {
    skip(entry, std::move(*why), graph, diagnostics);
    return true;
  }
  std::vector<std::string> inputs, missing;
  if (!why_inactive(lua, run)) inputs = needed_inputs(lua, run);
  add_mask_inputs(lua, run, MaskInputs::needed, inputs);
  for (const auto& input : inputs)
    if (!graph.context().auxiliary.contains(input)) missing.push_back(input);
  if (missing.empty()) return false;
  const std::string reason = fmt::format("no {} input", join(missing, " and ")) + layers_text(missing, graph.context()) +
                             hints_text(missing, graph.context());
  if (entry.required)
    throw ScriptError{{ErrorKind::script, fmt::format("effect '{}' is required, but there is {}", entry.name, reason),
                       entry.file, entry.line}};
  graph.add_skipped(entry.name, reason, missing, entry.can_lack);
  if (!graph.context().notes_lacks) warn_skipped(entry, reason, diagnostics);
  return true;
}

ImageRef Preset::State::build_entries(lua_State* lua, std::size_t begin, std::size_t end, GraphBuilder& graph,
                                      ImageRef image, const StackEntry*& current, Diagnostics& diagnostics) {
  for (std::size_t i = begin; i < end;) {
    const EntryRun& run = runs[i];
    const StackEntry& entry = run.entry;
    current = &entry;
    const std::size_t first = entry.first_of(i), middle = entry.middle_of(i), last = entry.end_of(i);
    i = last;
    if (!runtime->effects[static_cast<std::size_t>(run.effect)].is_group()) {
      image = build_entry(lua, run, graph, image, diagnostics);
      continue;
    }
    if (is_left_out(lua, run, graph, diagnostics)) continue;
    ImageRef made = image;
    if (!entry.is_mix()) {
      made = build_entries(lua, first, last, graph, image, current, diagnostics);
    } else {
      const ImageRef one = build_entries(lua, first, middle, graph, image, current, diagnostics);
      const ImageRef other = build_entries(lua, middle, last, graph, image, current, diagnostics);
      current = &entry;
      made = mixed(run, graph, one, other, entry.settings.front().second.number[0]);
    }
    current = &entry;
    if (made.id == image.id)
      graph.add_skipped(entry.name, "nothing in it runs");
    else
      image = composite(lua, run, graph, image, made);
  }
  return image;
}

Result<Graph> Preset::State::build(const BuildContext& context, Diagnostics& diagnostics) {
  Sandbox& box = *runtime->box;
  GraphBuilder graph(context, *shaders, ++builds);
  const StackEntry* current = nullptr;
  ImageRef image = graph.source();
  runtime->graph = &graph;
  runtime->depends = {};
  box.diagnostics = &diagnostics;
  auto error = box.run(file, [&](lua_State* lua) {
    scale_lengths(lua, context);
    graph.scale_lengths(length_scale);
    if (may_change) resolve(lua, context);
    if (needs_move) note_needs_now(lua, current);
    warn_without_position(*explanation, diagnostics);
    image = build_entries(lua, 0, runs.size(), graph, image, current, diagnostics);
  });
  runtime->graph = nullptr;
  box.diagnostics = nullptr;
  if (error) return with_entry(std::move(*error), current);
  return graph.finish(image.id);
}

std::string Preset::State::changed_when_repeated(const BuildContext& context, const Graph& graph) {
  Diagnostics silent;  // all was said the first time
  BuildContext other = context;
  other.frame += context.step;
  other.time += context.step / context.fps;
  (void)build(other, silent);  // what fails there fails when that frame is asked for
  const auto again = build(context, silent);
  const auto found = again ? first_difference(graph, *again) : std::nullopt;
  if (!found) return {};
  return fmt::format("effect '{}': build gives another graph the second time: it keeps state between frames ({})",
                     found->effect, found->what);
}

Result<Build> Preset::evaluate(const BuildContext& context, Diagnostics& diagnostics) {
  State& state = *state_;
  const bool first = state.evaluations++ == 0;
  if (first) state.first_frame = context.frame;
  auto built = state.build(context, diagnostics);
  if (!built) {
    Error error = std::move(built).error();
    const bool says_so = error.message.find(" at frame ") != std::string::npos;
    if (context.frame != state.first_frame && !says_so) error.trail.push_back("in frame " + number_text(context.frame));
    return error;
  }
  Graph graph = std::move(built).value();
  Dependencies depends = std::move(state.runtime->depends);
  std::string changing = first ? state.changed_when_repeated(context, graph) : "";
  if (!changing.empty()) diagnostics.warn_once(changing, changing);
  Build out{.context = context,
            .length_scale = state.length_scale,
            .graph = std::move(graph),
            .entries = state.entries,
            .explanation = state.explanation,
            .promises = {},
            .promise_error = {},
            .depends = std::move(depends),
            .changing = std::move(changing),
            .unread = {},
            .files = {}};
  out.promise_error = state.runtime->box->run(state.file, [&](lua_State* lua) {
    for (const auto& run : state.runs) out.promises.push_back({run.entry.name, invariants_of(lua, run, context.size)});
    if (state.runtime->note_reads) out.unread = unread_settings(lua, state.runs, out.graph);
  });
  out.files = probes();
  return out;
}

}  // namespace afterglow
