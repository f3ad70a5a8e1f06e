// SPDX-License-Identifier: MIT
#include "apps/bench_arguments.h"

#include <fmt/format.h>

#include "core/paths.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr const char* kSizes = "1920x1080,3840x2160";
constexpr const char* kReloadSizes = "1280x720";
constexpr const char* kResolutions = "960x540,1280x720,1920x1080,3840x2160";
/// --quick: enough to see that everything works.
constexpr const char* kQuickSizes = "320x180";
constexpr const char* kQuickResolutions = "160x90,320x180";
constexpr const char* kQuickVariants = "plain16f,chosen";
constexpr int kQuickRepeat = 3;

Result<std::vector<Size>> parse_sizes(const std::string& text) {
  std::vector<Size> out;
  for (const auto& part : split(text, ',')) {
    AFTERGLOW_TRY(const Size size, parse_size(trim(part), "--sizes"));
    out.push_back(size);
  }
  return out;
}

Error nothing(const char* what, const char* allowed) {
  return {ErrorKind::usage, what, "afterglow bench", 0, allowed, {}, {}};
}

}  // namespace

void BenchArguments::add(CLI::App& app) {
  app.add_option("PRESET", presets, "Looks to measure");
  app.add_option("--sizes", sizes, "Sizes of the picture (default 1920x1080,3840x2160)")->type_name("WxH,…");
  auto* edits = app.add_flag(
      "--reload", reload,
      "How long edits take from the save to the new picture: medians of 50 of a value and 50 of a shader, at "
      "1280x720 unless --sizes says otherwise");
  auto* shots =
      app.add_flag(
             "--temporal", temporal,
             "How steady what the looks add is: highlights that drift by parts of a pixel (or the shot of --picture "
             "shot.####.exr), and one scene at the --sizes (default 960x540,1280x720,1920x1080,3840x2160)")
          ->excludes(edits);
  app.add_option("--variants", variants,
                 fmt::format("Ways of execution, as `devices` and --report name them, or plain16f, plain32f, {} (what "
                             "`run` does), {} (the same, looking for values that are not finite, as `run` does)",
                             bench::kChosen, bench::kChecked))
      ->excludes(edits)
      ->excludes(shots)
      ->type_name("NAME,…");
  add_repeatable(app, "--vary", vary,
                 "Measures each value of a setting; errors are against the preset as it is (repeatable)",
                 "EFFECT.SETTING=VALUE,…")
      ->excludes(edits);
  preset.add_overrides(app);
  preset.add_paths(app);
  app.add_option("--scaling", scaling, "Also squares of 256, 512, … up to this side, as `run` executes them")
      ->excludes(edits)
      ->excludes(shots)
      ->check(CLI::Range(0, 16384))
      ->type_name("SIDE");
  app.add_option("--repeat", repeat, "Rounds; medians are of as many (default 9)")
      ->excludes(edits)
      ->excludes(shots)
      ->check(CLI::Range(1, 1000));
  app.add_option("--picture", picture, "Picture to measure on, scaled (default: a made scene)")
      ->excludes(edits)
      ->type_name("FILE");
  app.add_option("--goals", goals, "Measure the ratios that a file of goals names")
      ->excludes(edits)
      ->excludes(shots)
      ->type_name("FILE.json");
  app.add_flag("--quick", quick, "320x180, 3 rounds, two variants: to see that it works");
  app.add_option("-o,--out", folder, "Folder for bench.json, bench.csv, bench.html, front.svg (default: bench)")
      ->type_name("FOLDER");
  app.add_option("--compare", compare, "Print ratios to an older bench.json; exit code 1 beyond --threshold")
      ->excludes(edits)
      ->excludes(shots)
      ->type_name("OLD.json");
  app.add_option("--threshold", threshold, "How many times as slow is too slow (default 1.15)")
      ->check(above_zero())
      ->type_name("R");
  execution.add_max_error(app);
  execution.add_calibration(app);
  device.add(app);
}

Result<void> BenchArguments::check() const {
  if (temporal && presets.empty()) return nothing("--temporal needs a look to measure", "one or more PRESETs");
  if (reload && presets.empty()) return nothing("--reload needs a look to edit", "one or more PRESETs");
  if (presets.empty() && goals.empty()) return nothing("nothing to measure", "one or more PRESETs, --goals FILE");
  return {};
}

int BenchArguments::rounds() const { return quick ? kQuickRepeat : repeat; }

Result<StackOptions> BenchArguments::stack() const {
  StackOptions out;
  AFTERGLOW_TRY(out.preset, preset.options());
  out.max_error = execution.max_error;
  out.calibration = execution.calibration;
  out.cache_folder = cache_folder();
  out.max_memory = 64ull << 30;  // what does not fit is the device's to say
  return out;
}

Result<bench::MatrixRequest> BenchArguments::matrix() const {
  bench::MatrixRequest out;
  AFTERGLOW_TRY(out.presets, files());
  AFTERGLOW_TRY(out.base, stack());
  AFTERGLOW_TRY(out.sizes, parse_sizes(!sizes.empty() ? sizes : quick ? kQuickSizes : kSizes));
  AFTERGLOW_TRY(const auto named, bench::parse_variants(!variants.empty() ? variants
                                                        : quick           ? kQuickVariants
                                                                          : bench::kDefaultVariants));
  AFTERGLOW_TRY(out.variants, bench::vary_settings(named, vary));
  out.scaling = scaling;
  out.picture = picture;
  out.repeat = rounds();
  return out;
}

Result<bench::StabilityRequest> BenchArguments::shots() const {
  bench::StabilityRequest out{
      .presets = {}, .options = {}, .variants = {}, .sizes = {}, .shot = picture, .quick = quick};
  AFTERGLOW_TRY(out.presets, files());
  AFTERGLOW_TRY(out.options.device, device.options());
  AFTERGLOW_TRY(out.options.stack, stack());
  AFTERGLOW_TRY(const auto chosen, bench::parse_variants(bench::kChosen));
  AFTERGLOW_TRY(out.variants, bench::vary_settings(chosen, vary));
  AFTERGLOW_TRY(out.sizes, parse_sizes(!sizes.empty() ? sizes : quick ? kQuickResolutions : kResolutions));
  return out;
}

Result<std::vector<std::filesystem::path>> BenchArguments::files() const {
  std::vector<std::filesystem::path> out;
  for (const auto& name : presets) {
    AFTERGLOW_TRY(auto file, named_preset(name, preset.paths));
    const auto same = [&](const std::filesystem::path& other) { return other.stem() == file.stem(); };
    if (const auto other = std::ranges::find_if(out, same); other != out.end())
      return Error{ErrorKind::usage,
                   fmt::format("reports name looks by their files' names, and {} has the same", other->string()),
                   file.string(), 0, "one at a time, or another name"};
    out.push_back(std::move(file));
  }
  return out;
}

Result<std::vector<Size>> BenchArguments::reload_sizes() const {
  return parse_sizes(!sizes.empty() ? sizes : quick ? kQuickSizes : kReloadSizes);
}

}  // namespace afterglow
