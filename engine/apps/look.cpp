// SPDX-License-Identifier: MIT
#include "apps/look.h"

#include <set>

#include "batch/crop.h"
#include "core/paths.h"
#include "exec/calibration.h"
#include "exec/program_cache.h"
#include "graph/condition.h"
#include "graph/region.h"
#include "session/stack.h"
#include "shader/kernel.h"

namespace afterglow {

Result<Look> load_look(const PresetArguments& arguments, const AssumedPicture& assumed, Console& console) {
  AFTERGLOW_TRY(PresetOptions options, arguments.options());
  options.note_reads = true;
  AFTERGLOW_TRY(const std::filesystem::path file, arguments.preset_file());
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

namespace {

/// As `run` executes on a CPU device, the one that is always there.
ExecutionConfig execution_on_cpu() {
  const auto calibration = Calibration::shipped();
  DeviceInfo cpu;
  cpu.type = "cpu";
  return calibration ? calibration->find(cpu, 0).choice : ExecutionConfig{};
}

}  // namespace

ShaderFindings check_shaders(const Look& look) {
  const ExecutionConfig config = execution_on_cpu();
  KernelCompiler compiler{cache_folder() / "shaders"};  // the folder that Stack uses, so that `run` starts warm
  ShaderFindings found;
  std::set<Hash> checked;  // most of these graphs differ in their last kernel alone
  const auto check = [&](const FrameWork& work) {
    ShaderFindings more = check_kernels(*look.shaders, compiler, work, config, checked);
    std::ranges::move(more.errors, std::back_inserter(found.errors));
    std::ranges::move(more.warnings, std::back_inserter(found.warnings));
  };
  // As frames with alpha have it, and as opaque ones do.
  std::vector<Graph> graphs{look.build.graph};
  if (straight_passes(look.build.graph) > 0) graphs.push_back(without_division(look.build.graph));
  for (const Graph& graph : graphs) check({.graph = graph});
  if (found.errors.empty() && look.build.graph.result != look.build.graph.source) {
    // The last kernel once more, as it is for display files without and with transparency.
    for (const Graph& graph : graphs)
      for (const bool straight : {false, true}) {
        FrameWork work{.graph = graph, .unorm8 = true};
        encode_for_display(work.graph, {.straight_alpha = straight, .dither = true});
        check(work);
      }
  }
  std::set<std::string> seen;
  std::erase_if(found.errors, [&](const Error& error) { return !seen.insert(error.text()).second; });
  std::erase_if(found.warnings, [&](const std::string& warning) { return !seen.insert(warning).second; });
  return found;
}

}  // namespace afterglow
