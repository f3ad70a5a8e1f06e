// SPDX-License-Identifier: MIT
// `afterglow graph`: the passes a preset becomes, and what was skipped or fused, as dot, svg or json.
#include <fmt/format.h>

#include <memory>

#include "apps/command.h"
#include "apps/graph_view.h"
#include "apps/look.h"
#include "apps/output.h"
#include "apps/setting_text.h"
#include "apps/traffic_view.h"
#include "batch/crop.h"
#include "core/file_record.h"
#include "core/json_text.h"
#include "core/written_files.h"

namespace afterglow {
namespace {

struct GraphArguments {
  PresetArguments preset;
  AssumedPicture picture;
  std::string format, output;
  bool traffic = false;
  std::optional<double> bandwidth;
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

Result<TrafficOptions> traffic_options(const GraphArguments& arguments) {
  TrafficOptions options{.bandwidth = arguments.bandwidth, .part = {}};
  if (arguments.picture.region.empty()) return options;
  AFTERGLOW_TRY(const Rect region, parse_region(arguments.picture.region));
  AFTERGLOW_TRY(const Size size, parse_size(arguments.picture.size));
  const Rect whole{0, 0, size.width, size.height};
  AFTERGLOW_TRY(options.part, part_of_region(region, whole, whole));
  return options;
}

/// --traffic: a table, or JSON.
Result<std::string> traffic_of_look(const GraphArguments& arguments, const std::string& format, const Look& look) {
  AFTERGLOW_TRY(const TrafficOptions options, traffic_options(arguments));
  if (format == "json") return json_text(traffic_json(look.build.graph, options));
  return traffic_text(look.build.graph, look.preset->name(), options);
}

/// Whether -o may be written: it is none of the look's files, and no file of another kind lies there.
Result<void> check_output_of(const GraphArguments& arguments, const std::string& format, const Look& look) {
  const FileForm form = format == "json"  ? FileForm::json
                        : format == "dot" ? FileForm::dot
                        : format == "svg" ? FileForm::svg
                                          : FileForm::any;
  const SideFile side{"-o", arguments.output, form};
  return check_written({&side, 1}, {}, looked_at(*look.preset->probes()));
}

Result<void> write_text(const GraphArguments& arguments, const std::string& text) {
  if (!arguments.output.empty()) return output_file(arguments.output, text);
  output("{}", text);
  return {};
}

Result<void> run_graph(const GraphArguments& arguments, Console& console) {
  const bool table = arguments.traffic && arguments.format.empty() && !arguments.output.ends_with(".json");
  AFTERGLOW_TRY(const std::string format, table ? std::string("text") : format_of(arguments));
  if (arguments.traffic && format != "text" && format != "json")
    return Error{ErrorKind::usage, fmt::format("--traffic is no picture: there is no {} of it", format),
                 "afterglow graph", 0, "--format json, or no --format for a table"};
  if (arguments.bandwidth && !arguments.traffic)
    return Error{ErrorKind::usage, "--bandwidth belongs to --traffic", "afterglow graph"};
  AFTERGLOW_TRY(const Look look, load_look(arguments.preset, arguments.picture, console));
  AFTERGLOW_CHECK(check_output_of(arguments, format, look));
  if (arguments.traffic) {
    AFTERGLOW_TRY(const std::string told, traffic_of_look(arguments, format, look));
    return write_text(arguments, told);
  }
  const std::string& title = look.preset->name();
  Notes notes;
  for (const auto& entry : *look.build.entries)
    if (const std::string text = composition_text(entry); !text.empty()) notes.emplace_back(entry.name, text.substr(2));
  const std::string text = format == "svg"    ? graph_svg(look.build.graph, look.plan, title, notes)
                           : format == "json" ? graph_json(look.build.graph, look.plan, title, notes)
                                              : graph_dot(look.build.graph, look.plan, title, notes);
  return write_text(arguments, text);
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
  app->add_flag("--traffic", arguments->traffic,
                "In place of the passes: the bytes that kernels read and write, in each way of execution");
  app->add_option("--bandwidth", arguments->bandwidth,
                  "With --traffic: how long a device of so many GB/s takes for them")
      ->check(above_zero())
      ->type_name("GB/s");
  app->footer("Needs no Vulkan device.\nExample: afterglow graph presets/neon_night.lua -o neon.svg");
  return {app, [arguments](Console& console) { return run_graph(*arguments, console); }};
}

}  // namespace afterglow
