// SPDX-License-Identifier: MIT
// A sequence of four pictures, and what became of it.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {

class Sequence : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    for (int frame = 1; frame <= 4; ++frame) make_exr("in/shot.000" + std::to_string(frame) + ".exr");
    fs::create_directory(path("out"));
  }

  Outcome run_all(const std::vector<std::string>& more = {}, RunOptions options = {}) const {
    std::vector<std::string> arguments{"run", "look.lua", "in/shot.####.exr", "-o", "out/shot.####.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, options);
  }

  /// Names in out/ but for the notes of --resume.
  std::vector<std::string> outputs() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path("out")))
      if (entry.path().filename() != ".afterglow") names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// State of each frame in a report, in order.
  std::vector<std::string> states(const std::string& report) const {
    std::vector<std::string> all;
    const auto parsed = nlohmann::json::parse(read(report));
    for (const auto& frame : parsed.at("frames")) all.push_back(frame.at("state"));
    return all;
  }
};

}  // namespace afterglow::test
