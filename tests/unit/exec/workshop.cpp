// SPDX-License-Identifier: MIT
#include "workshop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

namespace afterglow {

namespace {

std::unique_ptr<Device> shared_device;
int errors_before = 0;

/// Weights of the texels around texel-space position p, one axis (math.md §1).
std::vector<std::pair<int, double>> taps_at(double p, Interpolation interpolation) {
  if (interpolation == Interpolation::nearest) return {{static_cast<int>(std::floor(p)), 1.0}};
  if (interpolation == Interpolation::linear) {
    const double t = p - 0.5, i = std::floor(t), f = t - i;
    return {{static_cast<int>(i), 1 - f}, {static_cast<int>(i) + 1, f}};
  }
  const double s = p + 0.5, c = std::floor(s), t = s - c;
  const int first = static_cast<int>(c) - 2;
  const double a = (1 - t) * (1 - t) * (1 - t) / 6, b = 2.0 / 3 - t * t + t * t * t / 2;
  const double d = t * t * t / 6;
  return {{first, a}, {first + 1, b}, {first + 2, 1 - a - b - d}, {first + 3, d}};
}

double read_at(const Picture64& image, double px, double py, int c, Interpolation interpolation) {
  double sum = 0;
  for (const auto& [y, wy] : taps_at(py, interpolation)) {
    for (const auto& [x, wx] : taps_at(px, interpolation)) sum += wx * wy * image.get(x, y, c);
  }
  return sum;
}

}  // namespace

double Picture64::get(int x, int y, int c) const {
  x = std::clamp(x, 0, size.width - 1);
  y = std::clamp(y, 0, size.height - 1);
  return pixels[(static_cast<std::size_t>(y) * size.width + x) * 4 + c];
}

Picture64 Picture64::of(Size size, const std::vector<float>& rgba) {
  Picture64 out(size);
  std::copy(rgba.begin(), rgba.end(), out.pixels.begin());
  return out;
}

std::vector<float> noise(Size size, unsigned seed, int channels) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> exponent(-3, 1.6f), unit(0, 1);
  std::vector<float> out(static_cast<std::size_t>(size.area()) * channels);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = i % 4 == 3 && channels == 4 ? unit(random) : std::pow(10.0f, exponent(random));
  return out;
}

Picture64 filter64(const Picture64& source, const Filter& filter, Size target) {
  std::vector<Tap2d> taps = filter.taps;
  if (taps.empty()) {
    for (const auto& y : filter.y) {
      for (const auto& x : filter.x) taps.push_back({x.offset, y.offset, x.weight * y.weight});
    }
  }
  Picture64 out(target);
  for (int y = 0; y < target.height; ++y) {
    for (int x = 0; x < target.width; ++x) {
      const double px = (2.0 * x + 1) * source.size.width / (2.0 * target.width);
      const double py = (2.0 * y + 1) * source.size.height / (2.0 * target.height);
      for (int c = 0; c < 4; ++c) {
        double sum = 0;
        for (const auto& tap : taps)
          sum += tap.weight * read_at(source, px + tap.dx, py + tap.dy, c, filter.interpolation);
        out.at(x, y, c) = sum;
      }
    }
  }
  return out;
}

void expect_near(const std::vector<float>& actual, const Picture64& expected, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(actual.size(), expected.pixels.size()) << what;
  std::vector<double> errors;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const double error = std::abs(actual[i] - expected.pixels[i]) / (std::abs(expected.pixels[i]) + 0.01);
    errors.push_back(std::isfinite(error) ? error : 1e30);
  }
  std::ranges::sort(errors);
  const auto at = static_cast<std::size_t>(std::ceil(0.9999 * static_cast<double>(errors.size()))) - 1;
  EXPECT_LE(errors[at], tolerance) << what;
  EXPECT_LE(errors.back(), 50 * tolerance) << what;
}

GraphBuilder::GraphBuilder(Size source) {
  graph_.images.push_back({"source", source, -1});
  graph_.source = 0;
}

ImageId GraphBuilder::auxiliary(const std::string& name, Size size) {
  graph_.images.push_back({name, size, -1});
  return graph_.auxiliary[name] = static_cast<ImageId>(graph_.images.size()) - 1;
}

ImageId GraphBuilder::add(Pass pass, Size size) {
  const auto id = static_cast<ImageId>(graph_.images.size());
  graph_.images.push_back({pass.name, size, static_cast<int>(graph_.passes.size())});
  pass.effect = "test";
  pass.output = id;
  graph_.passes.push_back(std::move(pass));
  return id;
}

ImageId GraphBuilder::pixel(const std::string& name, const std::string& shader, ImageId color,
                            std::map<std::string, ImageId> others, std::map<std::string, ParamValue> params,
                            std::map<std::string, double> constants) {
  Pass pass{.name = name,
            .kind = PassKind::pixel,
            .shader = shader,
            .params = std::move(params),
            .constants = std::move(constants)};
  pass.inputs.push_back({"source", color, true});
  const Size size = graph_.images[color].size;
  for (const auto& [input, image] : others) pass.inputs.push_back({input, image, graph_.images[image].size == size});
  return add(std::move(pass), size);
}

ImageId GraphBuilder::sample(const std::string& name, const std::string& shader, Size size,
                             std::map<std::string, ImageId> images, std::map<std::string, ParamValue> params) {
  Pass pass{.name = name, .kind = PassKind::sample, .shader = shader, .params = std::move(params)};
  for (const auto& [input, image] : images) pass.inputs.push_back({input, image, false});
  return add(std::move(pass), size);
}

ImageId GraphBuilder::filter(const std::string& name, ImageId source, Size size, const Filter& filter) {
  Pass pass{.name = name, .kind = PassKind::filter, .filter = filter};
  pass.inputs.push_back({"source", source, false});
  return add(std::move(pass), size);
}

Graph GraphBuilder::finish(ImageId result) {
  graph_.result = result;
  return graph_;
}

ParamValue number(double value) { return {ParamType::float1, {value}}; }

ParamValue vector(std::initializer_list<double> values) {
  static constexpr ParamType kTypes[] = {ParamType::float1, ParamType::float2, ParamType::float3, ParamType::float4};
  return {kTypes[values.size() - 1], values};
}

Device& Workshop::device() { return *shared_device; }

void Workshop::SetUpTestSuite() {
  Diagnostics diagnostics;
  auto made = Device::create({.validate = true}, diagnostics);
  ASSERT_TRUE(made) << made.error().text();
  shared_device = std::move(*made);
}

void Workshop::TearDownTestSuite() {
  if (!shared_device) return;
  const auto log = shared_device->validation_log();
  shared_device.reset();
  // Objects that were never destroyed are reported when the device goes.
  EXPECT_EQ(log->errors(), 0) << testing::PrintToString(log->messages());
}

void Workshop::SetUp() {
  ASSERT_TRUE(shared_device);
  errors_before = device().validation_errors();
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::path(testing::TempDir()) /
            fmt::format("afterglow_exec_{}_{}", info->test_suite_name(), info->name());
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_ / "shaders");
  library_ = std::make_unique<ShaderLibrary>(SearchPath{{folder_}, AFTERGLOW_PROJECT_FOLDER});
  compiler_ = std::make_unique<KernelCompiler>(std::filesystem::path());
}

void Workshop::TearDown() {
  EXPECT_EQ(device().validation_errors(), errors_before) << testing::PrintToString(device().validation_messages());
  std::filesystem::remove_all(folder_);
}

void Workshop::shader(const std::string& name, const std::string& text) {
  const auto file = folder_ / "shaders" / (name + ".glsl");
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

Result<std::unique_ptr<Program>> Workshop::try_program(const Graph& graph, const ProgramOptions& options) {
  return Program::create(device(), *library_, *compiler_, graph, options);
}

std::unique_ptr<Program> Workshop::program(const Graph& graph, const ProgramOptions& options) {
  auto made = try_program(graph, options);
  EXPECT_TRUE(made) << made.error().text();
  return made ? std::move(*made) : nullptr;
}

HostResult Workshop::run(const Graph& graph, const std::map<std::string, HostImage>& inputs,
                         const ProgramOptions& options, bool direct) {
  HostResult out;
  const auto made = program(graph, options);
  auto runner = FrameRunner::create(device(), options.max_memory, direct);
  EXPECT_TRUE(runner) << runner.error().text();
  if (!made || !runner) return out;
  const auto times = (*runner)->run(*made, inputs, out, KernelTiming::none);
  EXPECT_TRUE(times) << times.error().text();
  return out;
}

}  // namespace afterglow
