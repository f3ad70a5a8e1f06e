// SPDX-License-Identifier: MIT
// What the tests of the command line share: a folder of their own, small pictures and presets, and ways to look at the
// outcome.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "program.h"

namespace afterglow::test {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Exit codes, as in the README.
enum Exit { kDone = 0, kOther = 1, kUsage = 2, kScript = 3, kFiles = 4, kDevice = 5, kInterrupted = 130 };

class CliTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Runs the program in the test's folder.
  Outcome run(const std::vector<std::string>& arguments, RunOptions options = {}) const;

  fs::path path(const std::string& name) const { return folder_ / name; }
  std::string text(const std::string& name) const { return path(name).string(); }
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  /// All samples of a picture, as floats; empty, with a failure, when it cannot be read.
  std::vector<float> pixels_of(const std::string& name) const;
  /// Names of everything below the test's folder, sorted, hidden files too.
  std::vector<std::string> files() const;

  /// A small RGBA half EXR: a bright square on a dark ground, so that a bloom has something to do.
  void make_exr(const std::string& name, int width = 64, int height = 36) const;
  /// First half of a good EXR.
  void make_truncated_exr(const std::string& name) const;
  /// A preset of tone mapping alone.
  void make_preset(const std::string& name) const;

 private:
  fs::path folder_;
};

fs::path preset(const std::string& name);  ///< presets/NAME
/// Every preset that comes along, below presets/, sorted; not their effects.
std::vector<std::string> shipped_presets();
/// Its name as that of a test.
std::string test_name_of(const ::testing::TestParamInfo<std::string>& preset);
fs::path neon();  ///< tests/images/neon.exr

/// Exactly one line, which starts as errors do. `text` of Outcome::err.
::testing::AssertionResult is_one_error_line(const std::string& text);

}  // namespace afterglow::test
