// SPDX-License-Identifier: MIT
// What the tests of this room share: a validated device, shaders written on the spot, graphs put together by hand, and
// plain double-precision pictures to compare with.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exec/frame_runner.h"
#include "exec/program.h"

namespace afterglow {

/// A picture in double precision, RGBA.
struct Picture64 {
  Size size;
  std::vector<double> pixels;
  explicit Picture64(Size s) : size(s), pixels(static_cast<std::size_t>(s.area()) * 4) {}
  double& at(int x, int y, int c) { return pixels[(static_cast<std::size_t>(y) * size.width + x) * 4 + c]; }
  /// Clamped to the edge.
  double get(int x, int y, int c) const;
  static Picture64 of(Size size, const std::vector<float>& rgba);
};

/// HDR noise, the same for the same seed: values from 1e-3 to 40 with bright pixels next to dark ones, alpha in [0, 1].
std::vector<float> noise(Size size, unsigned seed, int channels = 4);

/// core/filter.h, word for word.
Picture64 filter64(const Picture64& source, const Filter& filter, Size target);

/// math.md §13. Fails the test unless the 99.99th percentile is within the tolerance and the worst within 50 times of
/// it.
void expect_near(const std::vector<float>& actual, const Picture64& expected, double tolerance,
                 const std::string& what);

/// Puts graphs together.
class GraphBuilder {
 public:
  explicit GraphBuilder(Size source);
  ImageId source() const { return graph_.source; }
  ImageId auxiliary(const std::string& name, Size size);
  /// The first input of a pixel pass is the colour; the target has its size.
  ImageId pixel(const std::string& name, const std::string& shader, ImageId color,
                std::map<std::string, ImageId> others = {}, std::map<std::string, ParamValue> params = {},
                std::map<std::string, double> constants = {});
  ImageId sample(const std::string& name, const std::string& shader, Size size, std::map<std::string, ImageId> images,
                 std::map<std::string, ParamValue> params = {});
  ImageId filter(const std::string& name, ImageId source, Size size, const Filter& filter);
  Graph finish(ImageId result);

 private:
  ImageId add(Pass pass, Size size);
  Graph graph_;
};

ParamValue number(double value);
ParamValue vector(std::initializer_list<double> values);

/// A device with validation, a compiler without disk cache and a folder of shaders. Fails the test at the end of which
/// a validation error was heard.
class Workshop : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  static void SetUpTestSuite();
  static void TearDownTestSuite();

  /// Writes shaders/NAME.glsl.
  void shader(const std::string& name, const std::string& text);
  std::unique_ptr<Program> program(const Graph& graph, const ProgramOptions& options = {});
  Result<std::unique_ptr<Program>> try_program(const Graph& graph, const ProgramOptions& options = {});
  /// A new runner, one frame.
  HostResult run(const Graph& graph, const std::map<std::string, HostImage>& inputs, const ProgramOptions& options = {},
                 bool direct = true);

  static Device& device();
  std::filesystem::path folder_;
  std::unique_ptr<ShaderLibrary> library_;
  std::unique_ptr<KernelCompiler> compiler_;
};

inline const Size kSizes[] = {{1, 1}, {1, 7}, {7, 1}, {2, 3}, {64, 64}, {101, 57}};

}  // namespace afterglow
