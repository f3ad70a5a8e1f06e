// SPDX-License-Identifier: MIT
// Devices: none, the wrong one, and validation-clean presets.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli_test.h"
#include "image/metrics.h"

namespace afterglow::test {
namespace {

class Devices : public CliTest {
 protected:
  /// A machine without any Vulkan driver.
  RunOptions without_driver() const {
    RunOptions options;
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) options.environment[name] = text("no-driver.json");
    return options;
  }
};

TEST_F(Devices, NoneIsExitCode5) {
  make_preset("look.lua");
  make_exr("a.exr");
  const auto before = files();
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png"}, without_driver());
  EXPECT_EQ(outcome.exit_code, kDevice);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("Vulkan"));
  EXPECT_EQ(files(), before);
}

TEST_F(Devices, ListOfNoneIsExitCode5) {
  const Outcome outcome = run({"devices"}, without_driver());
  EXPECT_EQ(outcome.exit_code, kDevice);
  EXPECT_TRUE(is_one_error_line(outcome.err));
}

TEST_F(Devices, UnknownNameSaysWhatThereIs) {
  make_preset("look.lua");
  make_exr("a.exr");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--device", "voodoo2"});
  EXPECT_EQ(outcome.exit_code, kDevice);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("voodoo2"));
  EXPECT_THAT(outcome.err, HasSubstr("allowed: "));
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(Devices, CheckGraphAndEffectsNeedNone) {
  make_preset("look.lua");
  for (const auto& arguments : {std::vector<std::string>{"check", "look.lua"}, {"graph", "look.lua"}, {"effects"}}) {
    const Outcome outcome = run(arguments, without_driver());
    EXPECT_EQ(outcome.exit_code, kDone) << arguments.front() << ": " << outcome.err;
  }
}

TEST_F(Devices, TableAndJsonListTheSame) {
  const Outcome table = run({"devices"}), json = run({"devices", "--json"});
  ASSERT_EQ(table.exit_code, kDone) << table.err;
  ASSERT_EQ(json.exit_code, kDone) << json.err;
  const auto list = nlohmann::json::parse(json.out);
  ASSERT_GE(list.size(), 1u);
  for (const auto& device : list) {
    EXPECT_THAT(table.out, HasSubstr(device.at("name").get<std::string>()));
    EXPECT_TRUE(device.at("usable").is_boolean());
  }
}

/// Processors as lavapipe can be told to see this one; other drivers do not listen, and make the same bytes.
class Processors : public CliTest {
 protected:
  std::vector<float> run_on(const std::string& name, const char* look,
                            const std::map<std::string, std::string>& processor) const {
    RunOptions options;
    options.environment = processor;
    options.environment["MESA_SHADER_CACHE_DIR"] = text("cache-" + name);
    const Outcome outcome = run(
        {"run", preset(look).string(), neon().string(), "-o", name + ".exr", "--type", "float", "--size", "320x180"},
        options);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return pixels_of(name + ".exr");
  }
};

TEST_F(Processors, MakeTheSameBytesOrNearlyTheSameNumbers) {
  for (const char* look : {"anamorphic_night.lua", "ldr_glow.lua"}) {
    SCOPED_TRACE(look);
    const auto best = run_on("best", look, {});
    ASSERT_FALSE(best.empty());
    const auto avx = run_on("avx", look, {{"GALLIUM_OVERRIDE_CPU_CAPS", "avx"}});
    EXPECT_EQ(run_on("narrow", look, {{"LP_NATIVE_VECTOR_WIDTH", "128"}}), best);
    const auto sse = run_on("sse", look, {{"GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1"}});
    ASSERT_EQ(avx.size(), best.size());
    ASSERT_EQ(sse.size(), best.size());
    for (const auto& [other, what] : {std::pair(&avx, "AVX"), std::pair(&sse, "SSE 4.1")}) {
      const ErrorMeasure error = measure_error(*other, best);
      RecordProperty(std::string(look) + what, fmt::format("{:.2g}, worst {:.2g}", error.percentile, error.worst));
      EXPECT_TRUE(within(error, 1e-5)) << what << ": " << error.percentile << ", worst " << error.worst;
    }
  }
}

class ShippedPresets : public CliTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(ShippedPresets, RunCleanUnderValidation) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--precision", "fp16"}, {"--reference"}}) {
    std::vector<std::string> arguments{
        "run", preset(GetParam()).string(), neon().string(), "-o", "out.png", "--validate", "--size", "161x90"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_TRUE(fs::exists(path("out.png")));
  }
}

TEST_P(ShippedPresets, PassCheckWithoutWarnings) {
  const Outcome outcome = run({"check", preset(GetParam()).string()});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Cli, ShippedPresets, ::testing::ValuesIn(shipped_presets()), test_name_of);

}  // namespace
}  // namespace afterglow::test
