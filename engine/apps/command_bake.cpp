// SPDX-License-Identifier: MIT
// `afterglow bake`: a look of pixel effects as a look-up table for other programs, with how far it is from the look.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/bake.h"
#include "apps/command.h"
#include "core/file_record.h"
#include "core/text.h"
#include "core/written_files.h"

namespace afterglow {
namespace {

struct BakeArguments {
  PresetArguments preset;
  DeviceArguments device;
  std::string output, shaper = "none";
  int size = 33;
  std::optional<double> frame;
  double fps = 24;
};

/// "fx.NAME" of the effect that has these settings; empty where none has.
std::string effect_for_tables(Console& console) {
  const auto effects = list_effects(search_path_for({}, {}), console.diagnostics());
  if (!effects) return {};
  for (const EffectSchema& effect : *effects) {
    const auto has = [&](const std::string& name) {
      return std::ranges::find(effect.settings, name, &SettingSchema::name) != effect.settings.end();
    };
    const auto file = std::ranges::find(effect.settings, "file", &SettingSchema::name);
    if (has("input") && has("output") && file != effect.settings.end() && std::ranges::count(file->choices, "cube") > 0)
      return "fx." + effect.name + " ";
  }
  return {};
}

/// An effect that loads the table; empty where none does.
std::string use_text(const BakeArguments& a, Shaper shaper, const std::string& extension, Console& console) {
  if (extension == ".png") return "";
  const char* input = shaper == Shaper::none ? "srgb" : extension == ".clf" ? "linear" : "acescct";
  const std::string file = SettingValue{.type = SettingType::text, .number = {}, .choice = a.output}.text();
  return fmt::format("in a look: {}{{ file = {}, input = \"{}\", output = \"srgb\" }}\n", effect_for_tables(console),
                     file, input);
}

Result<void> run_bake(const BakeArguments& a, Console& console) {
  const Shaper shaper = a.shaper == "log" ? Shaper::log : Shaper::none;
  AFTERGLOW_TRY(const std::string extension, cube_extension(a.output));
  AssumedPicture assumed;
  assumed.frame = a.frame.value_or(assumed.frame);
  assumed.fps = a.fps;
  AFTERGLOW_TRY(const Look look, load_look(a.preset, assumed, console));
  if (const auto refused = unbakeable(look); !refused.empty())
    return Error{ErrorKind::script,
                 fmt::format("a table knows a pixel's colour alone; these effects need more: {}", join(refused)),
                 a.preset.file, 0, "effects of colour, like those that `afterglow graph` shows as pixel passes"};
  const SideFile table{"-o", a.output, FileForm::any};
  AFTERGLOW_CHECK(check_written({&table, 1}, {}, looked_at(*look.preset->probes())));
  SessionOptions options;
  AFTERGLOW_TRY(options.device, a.device.options());
  AFTERGLOW_TRY(options.stack, ExecutionArguments{}.options());
  AFTERGLOW_TRY(options.stack.preset, a.preset.options());
  options.stack.reference = true;
  AFTERGLOW_TRY(const std::filesystem::path file, a.preset.preset_file());
  AFTERGLOW_TRY(const auto session, Session::open(file, options, console.diagnostics()));
  const BuildContext moment = usual_context(*look.preset, {}, assumed.frame, assumed.fps);
  const Through through = [&](Picture& colours) { return session->process(colours, moment); };
  AFTERGLOW_TRY(Cube cube, bake_cube(a.size, shaper, look.preset->keeps_negative().value_or(false), through));
  cube.of_view = ends_in_view(look.spaces);
  AFTERGLOW_TRY(const BakeError error, bake_error(cube, 20000, through));
  AFTERGLOW_CHECK(write_cube(cube, look.preset->name(), a.output));
  const bool brings_down = std::ranges::any_of(look.spaces, [](const EntrySpace& s) { return s.behind != s.before; });
  if (shaper == Shaper::none && brings_down)
    console.warning("the look takes scene light, but the table cuts off what is above 1; --shaper log takes it");
  if (look.preset->may_change() && !a.frame)
    console.warning(
        "the look may change from frame to frame, a table does not: it is that of frame 1; --frame chooses");
  fmt::print("{}: {}³, {}; against the look itself at most {:.2f}, on average {:.3f} of 255 codes\n", a.output, a.size,
             fmt::format("{} to {}", shaper == Shaper::log ? "ACEScct" : "sRGB codes",
                         cube.of_view ? "the codes of the look's view" : "sRGB codes"),
             error.most, error.mean);
  fmt::print("{}", use_text(a, shaper, extension, console));
  return {};
}

}  // namespace

Command add_bake_command(CLI::App& program) {
  auto* app = program.add_subcommand("bake", "Write a look of pixel effects as a look-up table (.cube, .clf, .png)");
  auto arguments = std::make_shared<BakeArguments>();
  arguments->preset.add(*app);
  arguments->device.add(*app);
  app->add_option("-o,--output", arguments->output, "FILE.cube, FILE.clf or FILE.png (blue by blue beside each other)")
      ->type_name("FILE")
      ->required();
  app->add_option("--size", arguments->size, "Entries on a side, 2 to 129 (default 33)")
      ->check(CLI::Range(2, 129))
      ->type_name("N");
  app->add_option("--shaper", arguments->shaper,
                  "none: the table takes sRGB codes. log: it takes ACEScct, and so light above 1 (a .clf scene-linear "
                  "Rec.709)")
      ->check(CLI::IsMember({"none", "log"}))
      ->type_name("SHAPER");
  app->add_option("--frame", arguments->frame, "Number of the frame whose look it is, of looks that move (default 1)")
      ->check(frame_numbers())
      ->type_name("N");
  app->add_option("--fps", arguments->fps, "Frames a second, for animated presets (default 24)")
      ->transform(frame_rates())
      ->type_name("N");
  app->footer(
      "The table gives sRGB codes of a display, or those of the view that the look ends in. Effects that look around, "
      "at places or back are refused.\n"
      "Example: afterglow bake look.lua -o look.cube --size 33 --shaper log");
  return {app, [arguments](Console& console) { return run_bake(*arguments, console); }};
}

}  // namespace afterglow
