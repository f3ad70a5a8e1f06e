// SPDX-License-Identifier: MIT
// How long an edit takes until its picture is there: real files, the real watcher, a preset with one effect more, whose
// setting or whose shader is changed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "play/figures.h"
#include "session/stack.h"

namespace afterglow {

struct ReloadBenchOptions {
  std::filesystem::path preset;
  StackOptions stack;
  Size size{1280, 720};
  int edits = 50;  ///< of each kind
};

/// Edits of one kind. Milliseconds.
struct ReloadRow {
  std::string kind;                      ///< "value", "shader"
  std::vector<double> seen;              ///< from just before the file is written until the picture is made
  std::vector<ReloadLatency> latencies;  ///< the same, by what it was spent on
};
struct ReloadBench {
  Size size;
  double frame = 0;  ///< median time of a frame of this preset, all of it run
  std::vector<ReloadRow> rows;
};

/// `step` is asked before each edit and may end it. Errors: script (the preset), io (temporary folder; an edit that is
/// not noticed), device.
Result<ReloadBench> measure_reloads(Device& device, const ReloadBenchOptions& options, Diagnostics& diagnostics,
                                    const std::function<Result<void>(const std::string& what)>& step);

std::string reload_bench_text(const ReloadBench& bench);
/// reload-PRESET-WxH.json in `folder`, which is made. Errors: io.
Result<void> write_reload_bench(const ReloadBench& bench, const std::filesystem::path& preset,
                                const std::string& device, const std::filesystem::path& folder);

}  // namespace afterglow
