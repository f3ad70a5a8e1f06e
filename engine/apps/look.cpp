#include "apps/look.h"

#include <set>

#include "apps/crop.h"
#include "core/paths.h"
#include "exec/describe.h"
#include "graph/region.h"
#include "session/display_encoding.h"
#include "shader/kernel.h"

namespace afterglow {

Result<Look> load_look(const PresetArguments& arguments, const AssumedPicture& assumed, Console& console) {
  AFTERGLOW_TRY(const PresetOptions options, arguments.options());
  AFTERGLOW_TRY(const std::filesystem::path file, arguments.preset_file());
  Look look;
  look.shaders = std::make_unique<ShaderLibrary>(search_path_for(file, options.paths));
  AFTERGLOW_TRY(Preset preset, Preset::load(file, options, *look.shaders, console.diagnostics()));
  look.preset = std::make_unique<Preset>(std::move(preset));
  AFTERGLOW_TRY(const BuildContext context, assumed.context(*look.preset));
  AFTERGLOW_TRY(look.graph, look.preset->build(context, console.diagnostics()));
  AFTERGLOW_CHECK(validate(look.graph));
  AFTERGLOW_TRY(look.spaces, look.preset->spaces());
  look.plan = make_plan(look.graph, {});
  if (!assumed.region.empty()) {
    AFTERGLOW_TRY(const Rect region, parse_region(assumed.region));
    const Rect whole{0, 0, context.size.width, context.size.height};
    AFTERGLOW_TRY(const Rect part, part_of_region(region, whole, whole));
    look.plan.skipped.push_back(skipped_pixels(look.graph, look.plan, regions(look.graph, look.plan, part)));
  }
  return look;
}

namespace {

// As `run` chooses on a CPU device, the one that is always there.
constexpr DescribeOptions kAssumed{
    .flag_non_finite = true, .storage_reads = true, .source_is_storage = true, .rows = kMaxRows, .hide_uniforms = true};

/// Compiles each distinct kernel once and gathers what is wrong.
class ShaderCheck {
 public:
  explicit ShaderCheck(ShaderLibrary& shaders) : shaders_(shaders) {}

  void run(const Graph& graph, const Plan& plan, const DescribeOptions& options) {
    for (const auto& kernel : plan.kernels) {
      const auto desc = describe_kernel(shaders_, graph, kernel, options);
      if (!desc) {
        keep(desc.error());
        continue;
      }
      const auto assembled = assemble(*desc);
      if (!assembled) {
        keep(assembled.error());
        continue;
      }
      if (!compiled_.insert(assembled->hash).second) continue;
      if (const auto result = compiler_.compile(*desc); !result) keep(result.error());
    }
  }

  std::vector<Error> errors;

 private:
  void keep(const Error& error) {
    if (seen_.insert(error.text()).second) errors.push_back(error);
  }

  ShaderLibrary& shaders_;
  KernelCompiler compiler_{cache_folder() / "shaders"};  // the folder that Stack uses, so that `run` starts warm
  std::set<std::string> seen_;
  std::set<Hash> compiled_;
};

}  // namespace

std::vector<Error> shader_errors(const Look& look) {
  ShaderCheck check(*look.shaders);
  check.run(look.graph, look.plan, kAssumed);
  if (!check.errors.empty() || look.graph.result == look.graph.source) return check.errors;
  // The last kernel once more, as it is for display files without and with transparency.
  for (const bool straight : {false, true}) {
    Graph graph = look.graph;
    encode_for_display(graph, {.straight_alpha = straight, .dither = true});
    DescribeOptions options = kAssumed;
    options.codes = true;
    const Plan plan = make_plan(graph, {});
    Plan last;
    last.kernels = {plan.kernels.back()};
    check.run(graph, last, options);
  }
  return check.errors;
}

}  // namespace afterglow
