// SPDX-License-Identifier: MIT
// The ways of execution that GPUs take, on a GPU that a layer imitates (gpu_layer.cpp): every command, every preset,
// with validation against that GPU's limits.

#include <nlohmann/json.hpp>

#include "cli_test.h"
#include "image/metrics.h"

namespace afterglow::test {
namespace {

using nlohmann::json;

constexpr const char* kWithoutRows = "fused fp32";
/// What the shipped table tells every CPU device; no GPU can write rows this way.
constexpr const char* kByRows = "fused fp32 storage-reads rows8";

class ImitatedGpu : public CliTest {
 protected:
  static RunOptions on_gpu() {
    RunOptions options;
    options.environment = {{"VK_ADD_LAYER_PATH", AFTERGLOW_GPU_LAYER_FOLDER},
                           {"VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_AFTERGLOW_gpu"},
                           {"AFTERGLOW_VALIDATE", "1"},
                           // lavapipe, which is behind it, leaks what it compiles again for values of parameters.
                           {"ASAN_OPTIONS", "detect_leaks=0"}};
    return options;
  }
  /// The program must be content, and so must the validation layer, an error of which is exit code 5.
  Outcome done(const std::vector<std::string>& arguments, const RunOptions& options = on_gpu()) const {
    const Outcome outcome = run(arguments, options);
    EXPECT_EQ(outcome.exit_code, kDone) << arguments.front() << ": " << outcome.err;
    return outcome;
  }
  /// A table of ways of execution that fits every device.
  std::string table_of(const std::string& choice) const {
    write("table.json", R"({"devices": [{"choices": [{"max_error": 0, "choice": ")" + choice + R"("}]}]})");
    return "table.json";
  }
  void expect_near(const std::string& made, const std::string& wanted, double error) const {
    const auto a = pixels_of(made), b = pixels_of(wanted);
    ASSERT_EQ(a.size(), b.size());
    const ErrorMeasure measure = measure_error(a, b);
    EXPECT_TRUE(within(measure, error)) << made << ": " << measure.percentile << ", worst " << measure.worst;
  }
  /// Of a pass with two ways, whose workgroups are too much for this GPU: the picture is that of the other way.
  void expect_drawn(const std::string& by_workgroups) const {
    make_exr("a.exr");
    write("effects/most.lua", R"(local fx = require "afterglow"
return fx.effect { name = "most", doc = "Times two.", at = "post_process", order = 50,
  build = function(g, s, source) return g:pass { shader = "most/one", compute = "most/many", source = source, size = source } end }
)");
    write("shaders/most/one.glsl",
          "uniform sampler2D source;\nvec4 sample_at(ivec2 pixel) { return fetch(source, pixel) * 2.0; }\n");
    write("shaders/most/many.glsl", by_workgroups);
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.most {}, fx.bloom { threshold = 0.5 } }\n");
    done({"run", "look.lua", "a.exr", "-o", "gpu.exr", "--calibration", table_of("fused fp32 compute"), "--type",
          "float"});
    ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "cpu.exr", "--type", "float"}).exit_code, kDone);
    expect_near("gpu.exr", "cpu.exr", 1e-5);
  }
};

TEST_F(ImitatedGpu, IsSeenAsOne) {
  const json list = json::parse(done({"devices", "--json"}).out);
  EXPECT_EQ(list.at(0).at("name"), "Imitated GPU");
  EXPECT_EQ(list.at(0).at("type"), "discrete");
}

/// Images between passes cannot be linear here, which is only known once the device is asked.
TEST_F(ImitatedGpu, RowsAreForDevicesThatCanWriteThem) {
  for (const char* look : {"neon_night.lua", "shallow_focus.lua"}) {
    std::vector<std::string> arguments{"run",   preset(look).string(), neon().string(),  "--size", "1280x720", "--type",
                                       "float", "--calibration",       table_of(kByRows)};
    arguments.insert(arguments.end(), {"-o", "gpu.exr"});
    done(arguments);
    arguments.back() = "cpu.exr";
    done(arguments, {});
    expect_near("gpu.exr", "cpu.exr", 1e-5);
  }
}

/// Where images of two channels cannot be drawn to, all hold four, which the report says; the picture is the same.
TEST_F(ImitatedGpu, FewChannelsAreForDevicesThatDrawThem) {
  RunOptions without = on_gpu();
  without.environment["AFTERGLOW_GPU_FOUR_CHANNELS"] = "1";
  EXPECT_TRUE(json::parse(done({"devices", "--json"}).out).at(0).at("few_channels"));
  EXPECT_FALSE(json::parse(done({"devices", "--json"}, without).out).at(0).at("few_channels"));
  for (const char* precision : {"fp32", "fp16"}) {
    std::vector<std::string> arguments{"run", preset("toon.lua").string(), neon().string(), "--size", "320x180"};
    arguments.insert(arguments.end(), {"--type", "float", "--precision", precision, "--report", "report.json"});
    arguments.insert(arguments.end(), {"-o", "few.exr"});
    done(arguments);
    const auto way = [&] { return json::parse(read("report.json")).at("session").at("choice").get<std::string>(); };
    EXPECT_EQ(way().find("four-channels"), std::string::npos);
    arguments.back() = "four.exr";
    done(arguments, without);
    EXPECT_NE(way().find("four-channels"), std::string::npos);
    EXPECT_EQ(pixels_of("few.exr"), pixels_of("four.exr"));
  }
}

TEST_F(ImitatedGpu, HistoriesRegionsLayersAndDisplayFiles) {
  for (int frame = 1; frame <= 3; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr", 96, 54);
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.auto_exposure {}, fx.bloom { threshold = 0.5 }, "
        "fx.tone_mapping {} }\n");
  const std::vector<std::string> sequence{"run", "look.lua", "in/a.####.exr", "--type", "float", "--precision", "fp32"};
  const auto with = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  done(with(sequence, {"-o", "gpu.####.exr", "--stats=passes"}));
  done(with(sequence, {"-o", "cpu.####.exr"}), {});
  for (const char* frame : {"0001", "0002", "0003"})
    expect_near("gpu." + std::string(frame) + ".exr", "cpu." + std::string(frame) + ".exr", 1e-5);
  done({"run", "look.lua", "in/a.0001.exr", "-o", "region.png", "--region", "7,5,40,30"});
  done({"run", "look.lua", "in/a.0001.exr", "-o", "layers.exr", "--keep-layers", "--nan-policy", "neighbour"});
  done({"run", "look.lua", "in/a.0001.exr", "-o", "reference.jpg", "--reference"});
}

/// It has 128 invocations a workgroup: of two ways it takes the one that it can.
TEST_F(ImitatedGpu, PassesWhoseWorkgroupsAreTooLargeAreDrawn) {
  expect_drawn(
      "layout(local_size_x = 16, local_size_y = 16) in;\nuniform sampler2D source;\n"
      "vec4 compute_at(ivec2 pixel) { return fetch(source, pixel) * 2.0; }\n");
}

/// Nor has it more than 16384 bytes to share.
TEST_F(ImitatedGpu, PassesWhoseWorkgroupsShareTooMuchAreDrawn) {
  expect_drawn(
      "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\nshared vec4 tile[1280];\n"
      "vec4 compute_at(ivec2 pixel) {\n  tile[gl_LocalInvocationIndex * 16u] = fetch(source, pixel);\n"
      "  return tile[gl_LocalInvocationIndex * 16u] * 2.0;\n}\n");
}

/// Its timestamps run over at the first pass.
TEST_F(ImitatedGpu, TimesOfPassesAreTimes) {
  make_exr("a.exr");
  done({"run", preset("neon_night.lua").string(), "a.exr", "-o", "a.png", "--stats=passes", "--report", "report.json"});
  const json report = json::parse(read("report.json"));
  const json& passes = report.at("frames").at(0).at("passes");
  ASSERT_FALSE(passes.empty());
  for (const auto& pass : passes) {
    EXPECT_GE(pass.at("milliseconds").get<double>(), 0);
    EXPECT_LT(pass.at("milliseconds").get<double>(), 60e3) << pass;
  }
}

TEST_F(ImitatedGpu, CalibratesAndRunsByItsOwnTable) {
  done({"calibrate", "--repeat", "1", "-o", "own.json"});
  make_exr("a.exr");
  done({"run", preset("neon_night.lua").string(), "a.exr", "-o", "a.png", "--calibration", "own.json"});
}

TEST_F(ImitatedGpu, IsMeasured) {
  done({"bench", preset("plain_aces.lua").string(), "--quick", "--sizes", "48x27", "-o", "out"});
  EXPECT_TRUE(fs::exists(path("out/bench.json")));
}

TEST_F(ImitatedGpu, Plays) {
  for (int frame = 1; frame <= 3; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr");
  done({"play", preset("neon_night.lua").string(), "in/a.####.exr", "--headless", "--fast", "--count", "6",
        "--screenshot", "shot.png"});
  EXPECT_TRUE(fs::exists(path("shot.png")));
}

TEST_F(ImitatedGpu, HostsRecordStacksOnIt) {
  RunOptions options = on_gpu();
  options.program = AFTERGLOW_EMBED;
  options.environment["AFTERGLOW_GPU_COHERENT"] = "1";  // as that host expects
  const Outcome outcome = run({preset("neon_night.lua").string()}, options);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.out << outcome.err;
}

TEST_F(ImitatedGpu, SidesBeyondItsLimitAreRefusedWithTheLimit) {
  make_exr("wide.exr", 600, 20);
  RunOptions options = on_gpu();
  options.environment["AFTERGLOW_GPU_SIDE"] = "512";
  const Outcome outcome = run({"run", preset("plain_aces.lua").string(), "wide.exr", "-o", "wide.png"}, options);
  EXPECT_EQ(outcome.exit_code, kDevice) << outcome.err;
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the device allows 512×512"));
  EXPECT_FALSE(fs::exists(path("wide.png")));
  done({"run", preset("plain_aces.lua").string(), "wide.exr", "-o", "narrow.png", "--size", "512x17"}, options);
}

/// Vulkan 1.1 and 1.2 with two extensions: the layer refuses what is newer, and validation says what it thinks of it.
TEST_F(ImitatedGpu, OlderVulkanSuffices) {
  make_exr("a.exr", 96, 54);
  for (const char* version : {"1.1", "1.2"}) {
    SCOPED_TRACE(version);
    RunOptions options = on_gpu();
    options.environment["AFTERGLOW_GPU_VULKAN"] = version;
    for (const char* look : {"neon_night.lua", "vhs_tape.lua", "shallow_focus.lua"}) {
      std::vector<std::string> arguments{"run",     preset(look).string(), "a.exr", "--type",
                                         "float",   "--precision",         "fp32",  "-o",
                                         "old.exr", "--stats=passes"};
      done(arguments, options);
      arguments[8] = "new.exr";
      done(arguments);
      EXPECT_EQ(pixels_of("old.exr"), pixels_of("new.exr")) << look;
    }
  }
}

TEST_F(ImitatedGpu, DevicesThatLackSomethingSayWhat) {
  make_exr("a.exr");
  RunOptions options = on_gpu();
  options.environment["AFTERGLOW_GPU_QUEUES"] = "compute";
  const std::vector<std::string> arguments{"run", preset("plain_aces.lua").string(), "a.exr", "-o", "a.png"};
  const Outcome computes = run(arguments, options);
  EXPECT_EQ(computes.exit_code, kDevice) << computes.err;
  EXPECT_THAT(computes.err, HasSubstr("lacks a graphics queue (those that it has only compute; passes are drawn)"));
  options = on_gpu();
  options.environment["AFTERGLOW_GPU_VULKAN"] = "1.0";
  const Outcome old = run(arguments, options);
  EXPECT_EQ(old.exit_code, kDevice) << old.err;
  EXPECT_THAT(old.err, HasSubstr("needs Vulkan 1.1, has 1.0"));
}

/// Half floats only where the effects promise their error: the shipped table allows them to every GPU.
TEST_F(ImitatedGpu, HalfFloatsAreTakenWhereEffectsPromiseTheirError) {
  make_exr("a.exr", 96, 54);
  write("glow.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom { threshold = 0.5 } }\n");
  write("edges.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom {}, fx.fxaa {} }\n");
  const auto report_of = [&](const std::string& look, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", look, "a.exr", "-o", "a.exr.exr", "--report", "report.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = done(arguments);
    return std::pair(json::parse(read("report.json")).at("session"), outcome.err);
  };
  EXPECT_EQ(report_of("glow.lua", {}).first.at("storage"), "fp16");
  EXPECT_EQ(report_of("glow.lua", {"--max-error", "1e-3"}).first.at("storage"), "fp32");
  const auto edges = report_of("edges.lua", {}).first;
  EXPECT_EQ(edges.at("storage"), "fp32");
  EXPECT_THAT(edges.at("choice_from").get<std::string>(),
              HasSubstr("; full floats, as in half floats 'fxaa' promises none"));
  write("graded.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { contrast = 10 } }\n");
  EXPECT_THAT(report_of("graded.lua", {}).first.at("choice_from").get<std::string>(),
              HasSubstr("'color_adjustments' promises an error for light up to 60 alone"));
  const auto [wished, said] = report_of("edges.lua", {"--precision", "fp16"});
  EXPECT_EQ(wished.at("storage"), "fp16");
  EXPECT_THAT(said,
              HasSubstr("precision fp16 may miss the error of 0.002 that is allowed (--max-error): in half floats "
                        "'fxaa' promises none"));
}

class PresetsOnImitatedGpu : public ImitatedGpu, public ::testing::WithParamInterface<std::string> {};

TEST_P(PresetsOnImitatedGpu, AreTheSameNumbersInFullFloats) {
  const std::vector<std::string> look{
      "run",           preset(GetParam()).string(), neon().string(), "--size", "161x90", "--type", "float",
      "--calibration", table_of(kWithoutRows)};
  const auto to = [&](const char* file) {
    auto arguments = look;
    arguments.insert(arguments.end(), {"-o", file});
    return arguments;
  };
  done(to("gpu.exr"));
  done(to("cpu.exr"), {});
  expect_near("gpu.exr", "cpu.exr", 1e-5);
}

/// Whatever the shipped table and the effects' promises make of an allowed error, it is kept: of a render, against the
/// same passes one by one in full floats.
TEST_P(PresetsOnImitatedGpu, KeepTheErrorThatIsAllowed) {
  const std::vector<std::string> look{
      "run", preset(GetParam()).string(), neon().string(), "--size", "320x180", "--type", "float"};
  const auto with = [&](const std::vector<std::string>& more) {
    auto arguments = look;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  done(with({"--reference", "-o", "truth.exr"}), {});
  for (const char* error : {"", "0.02"}) {
    SCOPED_TRACE(error);
    std::vector<std::string> more{"--report", "report.json", "-o", "gpu.exr"};
    if (*error) more.insert(more.end(), {"--max-error", error});
    done(with(more));
    const double allowed = json::parse(read("report.json")).at("session").at("max_error").get<double>();
    const ErrorMeasure measure = measure_error(pixels_of("gpu.exr"), pixels_of("truth.exr"));
    EXPECT_LE(measure.percentile, allowed);
    if (*error) continue;
    done(with({"-o", "cpu.exr"}), {});
    EXPECT_LE(measure_error(pixels_of("cpu.exr"), pixels_of("truth.exr")).percentile, allowed) << "on lavapipe";
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, PresetsOnImitatedGpu, ::testing::ValuesIn(shipped_presets()), test_name_of);

}  // namespace
}  // namespace afterglow::test
