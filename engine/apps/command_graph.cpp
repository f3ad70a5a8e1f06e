// SPDX-License-Identifier: MIT
// `afterglow graph`: the passes a preset becomes, and what was skipped or fused, as dot, svg or json.
#include <fmt/format.h>

#include <memory>

#include "apps/command.h"
#include "apps/graph_view.h"
#include "apps/look.h"
#include "apps/output.h"
#include "apps/setting_text.h"
#include "core/file.h"

namespace afterglow {
namespace {

struct GraphArguments {
  PresetArguments preset;
  AssumedPicture picture;
  std::string format, output;
};

/// --format, else the output's extension, else dot.
Result<std::string> format_of(const GraphArguments& arguments) {
  if (!arguments.format.empty()) return arguments.format;
  if (arguments.output.empty()) return std::string("dot");
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  for (const std::string known : {"dot", "svg", "json"})
    if (extension == "." + known) return known;
  return Error{ErrorKind::usage, fmt::format("the format of '{}' is not known by its name", arguments.output),
               "afterglow graph", 0, ".dot, .svg, .json, or --format"};
}

Result<void> run_graph(const GraphArguments& arguments, Console& console) {
  AFTERGLOW_TRY(const std::string format, format_of(arguments));
  AFTERGLOW_TRY(const Look look, load_look(arguments.preset, arguments.picture, console));
  const std::string& title = look.preset->name();
  Notes notes;
  for (const auto& entry : *look.build.entries)
    if (const std::string text = composition_text(entry); !text.empty()) notes.emplace_back(entry.name, text.substr(2));
  const std::string text = format == "svg"    ? graph_svg(look.build.graph, look.plan, title, notes)
                           : format == "json" ? graph_json(look.build.graph, look.plan, title, notes)
                                              : graph_dot(look.build.graph, look.plan, title, notes);
  if (!arguments.output.empty()) return write_file_atomically(arguments.output, text);
  output("{}", text);
  return {};
}

}  // namespace

Command add_graph_command(CLI::App& program) {
  auto* app = program.add_subcommand("graph", "Show the passes of a preset, and what was skipped or fused and why");
  auto arguments = std::make_shared<GraphArguments>();
  arguments->preset.add(*app);
  arguments->picture.add(*app);
  app->add_option("--format", arguments->format, "dot, svg or json (default: by the output's name, else dot)")
      ->check(CLI::IsMember({"dot", "svg", "json"}))
      ->type_name("FORMAT");
  app->add_option("-o,--output", arguments->output, "File to write (default: standard output)")->type_name("FILE");
  app->footer("Needs no Vulkan device.\nExample: afterglow graph presets/neon_night.lua -o neon.svg");
  return {app, [arguments](Console& console) { return run_graph(*arguments, console); }};
}

}  // namespace afterglow
