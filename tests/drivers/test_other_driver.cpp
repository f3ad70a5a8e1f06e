// SPDX-License-Identifier: MIT
// A second real Vulkan driver: SwiftShader, as Debian's chromium packages bring it (./dev test --drivers fetches it).
// Its built-in functions, filters and limits are its own. Skipped where it is not at hand.

#include <chrono>
#include <nlohmann/json.hpp>

#include "cli_test.h"
#include "image/metrics.h"

namespace afterglow::test {
namespace {

using nlohmann::json;

/// Full floats of two drivers (docs/determinism.md has what was measured).
constexpr double kDrivers = 1e-4;

class OtherDriver : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (!fs::exists(driver())) GTEST_SKIP() << "no SwiftShader: ./dev test --drivers fetches it";
  }
  static fs::path driver() {
    const char* given = std::getenv("AFTERGLOW_SWIFTSHADER");
    return given && *given ? given : "/usr/lib/chromium/vk_swiftshader_icd.json";
  }
  static RunOptions on_it() {
    RunOptions options;
    options.limit = std::chrono::seconds(600);  // it compiles and draws slowly
    options.environment = {{"VK_DRIVER_FILES", driver()}, {"VK_ICD_FILENAMES", driver()}, {"AFTERGLOW_VALIDATE", "1"}};
    return options;
  }
  Outcome done(const std::vector<std::string>& arguments, const RunOptions& options = on_it()) const {
    const Outcome outcome = run(arguments, options);
    EXPECT_EQ(outcome.exit_code, kDone) << arguments.front() << ": " << outcome.err;
    return outcome;
  }
};

TEST_F(OtherDriver, IsSeen) {
  const json list = json::parse(done({"devices", "--json"}).out);
  EXPECT_THAT(list.at(0).at("name").get<std::string>(), HasSubstr("SwiftShader"));
  EXPECT_EQ(list.at(0).at("usable"), true);
}

TEST_F(OtherDriver, CalibratesIsMeasuredAndPlays) {
  make_exr("a.exr");
  done({"calibrate", "--repeat", "1", "-o", "own.json"});
  done({"run", preset("neon_night.lua").string(), "a.exr", "-o", "a.png", "--calibration", "own.json"});
  done({"bench", preset("plain_aces.lua").string(), "--quick", "--sizes", "48x27", "-o", "out"});
  for (int frame = 1; frame <= 3; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr");
  done({"play", preset("neon_night.lua").string(), "in/a.####.exr", "--headless", "--fast", "--count", "6"});
}

TEST_F(OtherDriver, HostsRecordStacksOnIt) {
  RunOptions options = on_it();
  options.program = AFTERGLOW_EMBED;
  const Outcome outcome = run({preset("neon_night.lua").string()}, options);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.out << outcome.err;
}

/// Its images have sides to 8192.
TEST_F(OtherDriver, WideFramesAreRefusedWithItsLimit) {
  make_exr("wide.exr", 9000, 4);
  const Outcome outcome = run({"run", preset("plain_aces.lua").string(), "wide.exr", "-o", "wide.png"}, on_it());
  EXPECT_EQ(outcome.exit_code, kDevice) << outcome.err;
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the device allows 8192×8192"));
}

class PresetsOnOtherDriver : public OtherDriver, public ::testing::WithParamInterface<std::string> {};

/// Rows above the size from which they are made too: 1280×720.
TEST_P(PresetsOnOtherDriver, AreTheSameWithinTheBoundOfDrivers) {
  for (const char* size : {"161x90", "1280x720"}) {
    SCOPED_TRACE(size);
    std::vector<std::string> look{
        "run", preset(GetParam()).string(), neon().string(), "--size", size, "--type", "float", "--precision", "fp32",
        "-o"};
    look.emplace_back("other.exr");
    done(look);
    look.back() = "lavapipe.exr";
    done(look, {});
    const ErrorMeasure measure = measure_error(pixels_of("other.exr"), pixels_of("lavapipe.exr"));
    RecordProperty("percentile", std::to_string(measure.percentile));
    RecordProperty("worst", std::to_string(measure.worst));
    EXPECT_TRUE(within(measure, kDrivers)) << measure.percentile << ", worst " << measure.worst;
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, PresetsOnOtherDriver, ::testing::ValuesIn(shipped_presets()), test_name_of);

}  // namespace
}  // namespace afterglow::test
