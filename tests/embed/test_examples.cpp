// SPDX-License-Identifier: MIT
// The programs of examples/, run as their users do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "program.h"

namespace afterglow::test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Example : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  Outcome run(const char* program, const std::vector<std::string>& arguments) const {
    RunOptions options;
    options.folder = folder_;
    options.program = program;
    options.environment["ASAN_OPTIONS"] = "detect_leaks=0";  // hosts unload the driver, whose memory has no names then
    return run_program(arguments, options);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("afterglow_embed_" + std::to_string(getpid()));
  const std::string preset_ = AFTERGLOW_PROJECT_FOLDER "/presets/neon_night.lua";
};

TEST_F(Example, VulkanHostsRecordWhatRunMakes) {
  const Outcome outcome = run(EXAMPLE_VULKAN, {preset_});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("validation errors: 0"));
}

TEST_F(Example, PicturesInMemory) {
  const Outcome outcome = run(EXAMPLE_MEMORY, {"neon_night", "graded.ppm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string picture = read("graded.ppm");
  const std::string head = "P6\n320 180\n255\n";
  ASSERT_EQ(picture.size(), head.size() + 320 * 180 * 3);
  EXPECT_EQ(picture.substr(0, head.size()), head);
  const auto red = [&](int x, int y) {
    return static_cast<unsigned char>(picture[head.size() + static_cast<std::size_t>(y * 320 + x) * 3]);
  };
  EXPECT_GT(red(160, 90), 240);              // the square
  EXPECT_GT(red(135, 90), red(10, 10) + 8);  // its glow

  const Outcome less = run(EXAMPLE_MEMORY, {"neon_night", "less.ppm", "bloom.intensity=0"});
  ASSERT_EQ(less.exit_code, 0) << less.err;
  EXPECT_NE(read("less.ppm"), picture);
  const Outcome wrong = run(EXAMPLE_MEMORY, {"neon_night", "less.ppm", "bloom.intensty=0"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'intensity'?"));
  const Outcome full = run(EXAMPLE_MEMORY, {"neon_night", "/dev/full"});
  EXPECT_EQ(full.exit_code, 4);
  EXPECT_THAT(full.err, HasSubstr("/dev/full"));
}

TEST_F(Example, CppHostsFollowTheirPreset) {
  const Outcome outcome = run(EXAMPLE_MEMORY_CPP, {preset_, "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 frames; the mean of the last one is 0."));
  std::ofstream(folder_ / "broken.lua") << "local fx = require \"afterglow\"\nreturn fx.stack { fx.blom {} }\n";
  const Outcome broken = run(EXAMPLE_MEMORY_CPP, {"broken.lua"});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("broken.lua:2: error: "));
}

}  // namespace
}  // namespace afterglow::test
