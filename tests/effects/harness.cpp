// SPDX-License-Identifier: MIT
#include "harness.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "exec/frame_runner.h"
#include "files.h"
#include "image/metrics.h"
#include "script/build.h"
#include "shader/kernel.h"
#include "shader/library.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

/// One device for all tests of the process.
struct Harness {
  Diagnostics diagnostics;
  std::unique_ptr<Device> device;
  KernelCompiler compiler{fs::path()};

  static Harness& get() {
    static Harness harness;
    return harness;
  }

 private:
  Harness() {
    setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
    setenv("XDG_RUNTIME_DIR", testing::TempDir().c_str(), 0);
    auto made = Device::create({.device = "auto", .validate = true}, diagnostics);
    if (!made.ok()) throw std::runtime_error(made.error().text());
    device = std::move(*made);
  }
};

BuildContext context_of(const Scene& scene) {
  BuildContext context;
  context.size = scene.source.size();
  context.frame = scene.frame;
  context.time = (scene.frame - 1) / context.fps;
  if (scene.depth) context.auxiliary["depth"] = scene.depth->size();
  if (scene.normal) context.auxiliary["normal"] = scene.normal->size();
  if (scene.motion) context.auxiliary["motion"] = scene.motion->size();
  for (const auto& [name, image] : scene.layers) context.auxiliary["layer:" + name] = image.size();
  return context;
}

std::vector<float> floats(const reference::DoubleImage& image) {
  const auto values = reference::interleaved(image);
  return {values.begin(), values.end()};
}

std::string write_stack(const std::string& entries) {
  return write_test_file("stack.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n" + entries + "\n}\n")
      .string();
}

/// Throws std::runtime_error with the error's text, so that a failing step ends the test with its reason.
template <class T>
T need(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().text());
  return std::move(*result);
}

Made run(const Graph& graph, ShaderLibrary& shaders, const Scene& scene, Way way) {
  Harness& harness = Harness::get();
  Made made{.graph = graph, .size = scene.source.size(), .result = {}, .images = {}};
  const auto source = floats(scene.source);
  if (!made.ran()) {
    made.result = source;
    return made;
  }
  const ProgramOptions options{.config = {.storage = way == Way::fused_half ? Storage::fp16 : Storage::fp32,
                                          .storage_reads = way != Way::plain,
                                          .compute = way == Way::computed,
                                          .dispatched = way == Way::dispatched,
                                          .rows = way == Way::plain ? 1 : kMaxRows},
                               .reference = way == Way::plain,
                               .inputs_are_storage = way != Way::plain,
                               .worth = {0, 0},
                               .result_by_rows = way != Way::plain,
                               .result_stored = true};
  auto program = need(Program::create(*harness.device, shaders, harness.compiler, graph, options));
  made.kernels = program->plan().kernels.size();
  for (const auto& kernel : program->plan().kernels) made.dispatches += kernel.dispatched;
  auto runner = need(FrameRunner::create(*harness.device, options.max_memory));

  std::map<std::string, HostImage> inputs{{"source", {source.data(), made.size, 4}}};
  std::vector<float> depth, normal, motion;
  if (scene.motion) inputs["motion"] = {(motion = floats(*scene.motion)).data(), scene.motion->size(), 4};
  if (scene.depth) inputs["depth"] = {(depth = floats(*scene.depth)).data(), scene.depth->size(), 4};
  std::map<std::string, std::vector<float>> layers;
  for (const auto& [name, image] : scene.layers)
    inputs["layer:" + name] = {(layers[name] = floats(image)).data(), image.size(), 4};
  if (scene.normal) inputs["normal"] = {(normal = floats(*scene.normal)).data(), scene.normal->size(), 4};
  HostResult result;
  need(runner->run(*program, inputs, result, KernelTiming::none));
  made.result = std::move(result.pixels);
  made.clamped = result.clamped;
  if (way == Way::plain)
    for (const auto& pass : graph.passes)
      made.images[pass.name] =
          pass.output == graph.result ? made.result : need(runner->read_image(*program, pass.output)).pixels;
  return made;
}

}  // namespace

reference::DoubleImage Made::image(const std::string& pass) const {
  return reference::from_floats(images.at(pass).data(), size_of(pass), 4);
}

Size Made::size_of(const std::string& pass) const {
  for (const auto& p : graph.passes)
    if (p.name == pass) return graph.images[static_cast<std::size_t>(p.output)].size;
  throw std::runtime_error("no pass " + pass);
}

Made run_preset(const fs::path& file, const Scene& scene, Way way, double length_scale) {
  Harness& harness = Harness::get();
  ShaderLibrary shaders(search_path_for(file, {}));
  auto preset = need(Preset::load(file, {}, shaders, harness.diagnostics));
  BuildContext context = context_of(scene);
  context.length_scale = length_scale;
  const Graph graph = need(preset.evaluate(context, harness.diagnostics)).graph;
  const auto valid = validate(graph);
  if (!valid.ok()) throw std::runtime_error(valid.error().text());
  return run(graph, shaders, scene, way);
}

Made run_stack(const std::string& entries, const Scene& scene, Way way, double length_scale) {
  return run_preset(write_stack(entries), scene, way, length_scale);
}

std::string build_error(const std::string& entries, const Scene& scene) {
  Harness& harness = Harness::get();
  const auto file = write_stack(entries);
  ShaderLibrary shaders(search_path_for(file, {}));
  auto preset = Preset::load(file, {}, shaders, harness.diagnostics);
  if (!preset.ok()) return preset.error().text();
  const auto graph = preset->evaluate(context_of(scene), harness.diagnostics);
  return graph.ok() ? "" : graph.error().text();
}

testing::AssertionResult agrees(const std::vector<float>& device, const reference::DoubleImage& expected,
                                double tolerance, int channels) {
  std::vector<float> x;
  std::vector<double> wanted;
  if (device.size() != expected.pixels.size() * 4)
    return testing::AssertionFailure() << "sizes differ: " << device.size() / 4 << " pixels, expected "
                                       << expected.pixels.size();
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    for (int c = 0; c < channels; ++c) {
      x.push_back(device[4 * i + static_cast<std::size_t>(c)]);
      wanted.push_back(expected.pixels[i][c]);
    }
  const auto error = measure_error(x, std::span<const double>(wanted));
  if (within(error, tolerance)) return testing::AssertionSuccess();
  const auto pixel = static_cast<int>(error.worst_index) / channels;
  return testing::AssertionFailure() << fmt::format(
             "error {:.3g} (99.99 %), {:.3g} (worst, pixel {} {} channel {}: {:.9g}, expected {:.9g}), tolerance "
             "{:.1g}, {}x{}",
             error.percentile, error.worst, pixel % expected.width, pixel / expected.width,
             static_cast<int>(error.worst_index) % channels, x[error.worst_index], wanted[error.worst_index], tolerance,
             expected.width, expected.height);
}

testing::AssertionResult all_finite(const std::vector<float>& pixels) {
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (!std::isfinite(pixels[i])) return testing::AssertionFailure() << "sample " << i << " is " << pixels[i];
  return testing::AssertionSuccess();
}

testing::AssertionResult alpha_is_kept(const Made& made, const Scene& scene) {
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i)
    if (made.result[4 * i + 3] != static_cast<float>(scene.source.pixels[i].a))
      return testing::AssertionFailure() << "pixel " << i << ": alpha " << made.result[4 * i + 3] << " was "
                                         << scene.source.pixels[i].a;
  return testing::AssertionSuccess();
}

void Effects::TearDown() {
  const auto& device = *Harness::get().device;
  EXPECT_EQ(device.validation_errors(), 0) << testing::PrintToString(device.validation_messages());
}

}  // namespace afterglow
