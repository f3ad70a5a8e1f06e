// SPDX-License-Identifier: MIT
// One command of the program: its options, declared on a CLI11 subcommand, and what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

#include "apps/console.h"
#include "core/result.h"

namespace afterglow {

struct Command {
  CLI::App* options = nullptr;  ///< owned by the program's CLI::App
  std::function<Result<void>(Console&)> run;
  std::vector<std::string>* behind = nullptr;  ///< where words behind `--` go, of a command that hands them on
};

// Each adds itself to the program; one file a command.
Command add_run_command(CLI::App& program);
Command add_check_command(CLI::App& program);
Command add_graph_command(CLI::App& program);
Command add_explain_command(CLI::App& program);
Command add_effects_command(CLI::App& program);
Command add_set_command(CLI::App& program);
Command add_new_command(CLI::App& program);
Command add_devices_command(CLI::App& program);
Command add_bench_command(CLI::App& program);
Command add_calibrate_command(CLI::App& program);
Command add_play_command(CLI::App& program);
Command add_stress_command(CLI::App& program);
Command add_bake_command(CLI::App& program);
Command add_farm_command(CLI::App& program);
Command add_completion_command(CLI::App& program);
Command add_man_command(CLI::App& program);

}  // namespace afterglow
