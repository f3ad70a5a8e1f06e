// SPDX-License-Identifier: MIT
#include "apps/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "batch/crop.h"
#include "core/paths.h"
#include "exec/calibration.h"
#include "exec/program_cache.h"
#include "graph/condition.h"
#include "graph/region.h"
#include "script/explanation.h"
#include "session/stack.h"
#include "shader/kernel.h"

namespace afterglow {

Result<Look> load_look(const PresetArguments& arguments, const AssumedPicture& assumed, Console& console) {
  AFTERGLOW_TRY(PresetOptions options, arguments.options());
  options.note_reads = true;
  AFTERGLOW_TRY(const std::filesystem::path file, arguments.preset_file());
  arguments.tell_of_namesake(file, console.diagnostics());
  Look look;
  look.shaders = std::make_unique<ShaderLibrary>(search_path_for(file, options.paths));
  AFTERGLOW_TRY(Preset preset, Preset::load(file, options, *look.shaders, console.diagnostics()));
  look.preset = std::make_unique<Preset>(std::move(preset));
  AFTERGLOW_TRY(const BuildContext context, assumed.context(*look.preset));
  AFTERGLOW_TRY(look.build, look.preset->evaluate(context, console.diagnostics()));
  AFTERGLOW_CHECK(validate(look.build.graph));
  AFTERGLOW_TRY(look.spaces, look.preset->spaces());
  look.plan = make_plan(look.build.graph, {});
  if (!assumed.region.empty()) {
    AFTERGLOW_TRY(const Rect region, parse_region(assumed.region));
    const Rect whole{0, 0, context.size.width, context.size.height};
    AFTERGLOW_TRY(const Rect part, part_of_region(region, whole, whole));
    look.plan.skipped.push_back(
        skipped_pixels(look.build.graph, look.plan, regions(look.build.graph, look.plan, part)));
  }
  return look;
}

std::set<std::string> moving_passes(const Look& look) {
  BuildContext context = look.build.context;
  context.frame += context.step;
  context.time += context.step / context.fps;
  Diagnostics silent;
  const auto next = look.preset->evaluate(context, silent);
  if (!next) return {};  // there may be no such frame
  std::set<std::string> moving;
  std::set<ImageId> images;
  for (const Pass& pass : look.build.graph.passes) {
    const auto then = std::ranges::find(next->graph.passes, pass.name, &Pass::name);
    const bool same = then != next->graph.passes.end() && then->params == pass.params;
    if (same && std::ranges::none_of(pass.inputs, [&](const PassInput& in) { return images.contains(in.image); }))
      continue;
    moving.insert(pass.name);
    images.insert(pass.output);
  }
  return moving;
}

namespace {

/// As `run` executes on a CPU device, the one that is always there.
ExecutionConfig execution_on_cpu() {
  const auto calibration = Calibration::shipped();
  DeviceInfo cpu;
  cpu.type = "cpu";
  return calibration ? calibration->find(cpu, 0).choice : ExecutionConfig{};
}

bool is_skipped(const Build& build, const std::string& entry) {
  return std::ranges::find(build.graph.skipped, entry, &Skipped::name) != build.graph.skipped.end();
}

bool moves(const EntryHistory& entry) {
  const auto setting_moves = [](const SettingHistory& setting) {
    return !setting.overridden && (!setting.volumes.empty() || (!setting.kind.empty() && setting.kind != "fixed"));
  };
  return std::ranges::any_of(entry.settings, setting_moves) || std::ranges::any_of(entry.composition, setting_moves);
}

/// Compiles kernels, each once.
class KernelCheck {
 public:
  explicit KernelCheck(const Look& look) : look_(look) {}
  ShaderFindings found;

  /// As frames with alpha have the graph, and as opaque ones do.
  void check(const Graph& graph) {
    std::vector<Graph> graphs{graph};
    if (straight_passes(graph) > 0) graphs.push_back(without_division(graph));
    for (const Graph& one : graphs) check({.graph = one});
    if (!found.errors.empty() || graph.result == graph.source) return;
    // The last kernel once more, as it is for display files without and with transparency.
    for (const Graph& one : graphs)
      for (const bool straight : {false, true}) {
        FrameWork work{.graph = one, .unorm8 = true};
        encode_for_display(work.graph, {.straight_alpha = straight, .dither = true});
        check(work);
      }
  }

 private:
  void check(const FrameWork& work) {
    ShaderFindings more = check_kernels(*look_.shaders, compiler_, work, config_, checked_);
    std::ranges::move(more.errors, std::back_inserter(found.errors));
    std::ranges::move(more.warnings, std::back_inserter(found.warnings));
  }

  const Look& look_;
  const ExecutionConfig config_ = execution_on_cpu();
  KernelCompiler compiler_{cache_folder() / "shaders"};  // the folder that Stack uses, so that `run` starts warm
  CheckedKernels checked_;                               // most of these graphs differ in their last kernel alone
};

}  // namespace

LookFindings check_shaders(const Look& look) {
  constexpr double kLastFrame = 1025;
  KernelCheck kernels(look);
  kernels.check(look.build.graph);
  std::vector<std::string> waiting;
  for (const EntryHistory& entry : look.build.explanation->entries)
    if (is_skipped(look.build, entry.name) && moves(entry)) waiting.push_back(entry.name);
  for (double step = 1; !waiting.empty() && 1 + step <= kLastFrame && kernels.found.errors.empty(); step *= 2) {
    BuildContext context = look.build.context;
    context.frame = 1 + step;
    context.time = context.frame / context.fps;
    Diagnostics silent;
    const auto build = look.preset->evaluate(context, silent);
    if (!build) continue;  // there may be no such frame
    const auto ran = std::erase_if(waiting, [&](const std::string& entry) { return !is_skipped(*build, entry); });
    if (ran > 0) kernels.check(build->graph);
  }
  LookFindings out{std::move(kernels.found), std::move(waiting)};
  std::set<std::string> seen;
  std::erase_if(out.shaders.errors, [&](const Error& error) { return !seen.insert(error.text()).second; });
  std::erase_if(out.shaders.warnings, [&](const std::string& warning) { return !seen.insert(warning).second; });
  return out;
}

std::vector<std::string> check_odd_sizes(const Look& look) {
  std::vector<std::string> out;
  for (const Size size : {Size{1279, 719}, Size{321, 181}}) {
    BuildContext context = look.build.context;
    context.size = size;
    for (auto& [name, of] : context.auxiliary) of = size;
    Diagnostics silent;
    const auto build = look.preset->evaluate(context, silent);
    const auto good = build ? validate(build->graph) : Result<void>(build.error());
    if (!good) out.push_back(fmt::format("pictures of {}x{} pixels: {}", size.width, size.height, good.error().text()));
  }
  return out;
}

}  // namespace afterglow
