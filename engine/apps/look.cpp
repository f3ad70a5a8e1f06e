#include "apps/look.h"

#include <set>

#include "core/paths.h"
#include "exec/describe.h"
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
  look.plan = make_plan(look.graph, {});
  return look;
}

namespace {

// As `run` chooses on a CPU device, the one that is always there.
constexpr DescribeOptions kAssumed{.storage_reads = true, .source_is_storage = true, .rows = kMaxRows};

}  // namespace

std::vector<Error> shader_errors(const Look& look) {
  KernelCompiler compiler(cache_folder() / "shaders");  // the folder that Stack uses, so that `run` starts warm
  std::vector<Error> errors;
  std::set<std::string> seen;
  std::set<Hash> compiled;
  const auto keep = [&](const Error& error) {
    if (seen.insert(error.text()).second) errors.push_back(error);
  };
  for (const auto& kernel : look.plan.kernels) {
    const auto desc = describe_kernel(*look.shaders, look.graph, kernel, kAssumed);
    if (!desc) {
      keep(desc.error());
      continue;
    }
    const auto assembled = assemble(*desc);
    if (!assembled) {
      keep(assembled.error());
      continue;
    }
    if (!compiled.insert(assembled->hash).second) continue;
    if (const auto result = compiler.compile(*desc); !result) keep(result.error());
  }
  return errors;
}

}  // namespace afterglow
