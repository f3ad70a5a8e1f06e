// SPDX-License-Identifier: MIT
// What kernels compute, on a device: filters against their formula in double precision, the prelude, rounding to half
// floats.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <random>

#include "kernel_runner.h"
#include "shader_files.h"

namespace afterglow {
namespace {

/// Random light over seven orders of magnitude, each texel unlike its neighbours.
TestImage random_light(Size size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> exponent(-3.0f, 4.0f);
  TestImage image{size, std::vector<float>(static_cast<std::size_t>(size.area()) * 4)};
  for (auto& value : image.rgba) value = std::pow(10.0f, exponent(random));
  return image;
}

/// Values near 1 that change by 0.05 a texel or less: 8-bit fractions of a texture unit matter little, a wrong texel
/// does.
TestImage smooth_light(Size size) {
  TestImage image{size, std::vector<float>(static_cast<std::size_t>(size.area()) * 4)};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (int c = 0; c < 4; ++c)
        image.at(x, y)[c] =
            2.0f + 0.1f * std::sin(0.4f * static_cast<float>(x + c)) + 0.1f * std::cos(0.5f * static_cast<float>(y));
  return image;
}

/// The texels and weights of one read at (2x + 1)·n_src/(2·n_dst) + offset along an axis: filter.h and math.md §1, in
/// doubles.
std::vector<std::pair<int, double>> axis_reads(const Filter& filter, int x, int n_src, int n_dst, double offset) {
  const long long dividend = (2ll * x + 1) * n_src, divisor = 2ll * n_dst;
  std::vector<std::pair<int, double>> reads;
  const auto inside = [&](double i) {
    if (filter.edges == Edges::mirror &&
        (i < 0 || i >= n_src)) {  // the place in a period of the picture and its mirror
      const double n = n_src, place = i - 2 * n * std::floor(i / (2 * n));
      return static_cast<int>(std::min(place, 2 * n - 1 - place));
    }
    return static_cast<int>(std::clamp(i, 0.0, n_src - 1.0));
  };
  if (filter.interpolation == Interpolation::nearest) {
    const double whole = std::floor(offset);  // the offsets of these tests are multiples of a half: no rounding at ties
    const long long twice = dividend * 2 + static_cast<long long>((offset - whole) * 2) * divisor;
    return {{inside(std::floor(static_cast<double>(twice) / static_cast<double>(2 * divisor)) + whole), 1.0}};
  }
  const double p = static_cast<double>(dividend) / static_cast<double>(divisor) + offset;
  if (filter.interpolation == Interpolation::linear) {
    const double i = std::floor(p - 0.5), f = p - 0.5 - i;
    return {{inside(i), 1 - f}, {inside(i + 1), f}};
  }
  const double s = p + 0.5, c = std::floor(s), t = s - c;
  const double w[4] = {std::pow(1 - t, 3) / 6, 2.0 / 3 - t * t + t * t * t / 2,
                       1.0 / 6 + t / 2 + t * t / 2 - t * t * t / 2, t * t * t / 6};
  for (int k = 0; k < 4; ++k) reads.emplace_back(inside(c - 2 + k), w[k]);
  return reads;
}

struct Expected {
  double value = 0, magnitude = 0;
};

Expected expected(const Filter& filter, const TestImage& source, Size target, int x, int y, int channel) {
  std::vector<Tap2d> taps = filter.taps;
  if (filter.separable())
    for (const auto& a : filter.x)
      for (const auto& b : filter.y) taps.push_back({a.offset, b.offset, a.weight * b.weight});
  Expected out;
  for (const auto& tap : taps)
    for (const auto& [row, row_weight] : axis_reads(filter, y, source.size.height, target.height, tap.dy))
      for (const auto& [column, column_weight] : axis_reads(filter, x, source.size.width, target.width, tap.dx)) {
        const double part = tap.weight * row_weight * column_weight * source.at(column, row)[channel];
        out.value += part;
        out.magnitude += std::abs(part);
      }
  return out;
}

struct Sizes {
  Size source, target;
};

/// Sizes that share a kernel.
struct Case {
  const char* name;
  AxisRatio ratio_x, ratio_y;
  std::vector<Sizes> sizes;
};

struct NamedFilter {
  const char* name;
  Filter filter;
};

constexpr auto kNearest = Interpolation::nearest;
constexpr auto kLinear = Interpolation::linear;
constexpr auto kCubic = Interpolation::cubic_bspline;

std::vector<Tap> gaussian_halving() {
  const double w[] = {0.01621622, 0.05405405, 0.12162162, 0.19459459, 0.22702703};
  std::vector<Tap> taps;
  for (int i = -4; i <= 4; ++i) taps.push_back({2.0 * i, w[4 - std::abs(i)]});
  return taps;
}

const std::vector<NamedFilter>& filters() {
  static const std::vector<NamedFilter> kFilters = {
      {"nearest", {kNearest}},
      {"nearest_taps", {kNearest, {{-1.5, 0.25}, {0, 0.5}, {0.5, 0.25}}, {{-2, 0.5}, {1.5, 0.5}}}},
      {"bilinear", {kLinear}},
      {"bspline", {kCubic}},
      {"gaussian_halving", {kLinear, gaussian_halving(), {{0, 1}}}},
      {"gaussian_merged",
       {kLinear,
        {{0, 1}},
        {{-3.23076923, 0.07027027},
         {-1.38461538, 0.31621622},
         {0, 0.22702703},
         {1.38461538, 0.31621622},
         {3.23076923, 0.07027027}}}},
      {"binomial",
       {kLinear, {{0, 1}}, {{-2, 66. / 4070}, {-1, 220. / 4070}, {0, 792. / 4070}, {1, 220. / 4070}, {2, 66. / 4070}}}},
      {"bspline_taps", {kCubic, {{-1, 0.25}, {0.25, 0.5}, {1, 0.25}}, {{0, 0.5}, {1, 0.5}}}},
      {"plus", {kLinear, {{0, 1}}, {{0, 1}}, {{1, 0, 0.25}, {0, 1, 0.25}, {-1, 0, 0.25}, {0, -1, 0.25}}}},
      {"free_taps",
       {kLinear, {{0, 1}}, {{0, 1}}, {{0.3, -1.7, 0.5}, {-2.5, 0.5, 0.25}, {0.3, 2, 1.25}, {0.3, -1.7, 0.5}}}},
      {"free_nearest", {kNearest, {{0, 1}}, {{0, 1}}, {{1, 0, 0.5}, {-0.5, 2.5, 0.5}}}},
      {"free_bspline", {kCubic, {{0, 1}}, {{0, 1}}, {{1, 0, 0.5}, {-0.5, 0.75, 0.5}}}},
      {"sharpen", {kLinear, {{-1, -0.5}, {0, 2}, {1, -0.5}}, {{-1, -0.5}, {0, 2}, {1, -0.5}}}},
      {"nothing", {kLinear, {{0, 0}}, {{0, 1}}}},
      {"mirrored_halving",
       {kLinear, {{-8, 0.1}, {-3.5, 0.2}, {0, 0.4}, {4, 0.2}, {8, 0.1}}, {{-1, 0.5}, {1, 0.5}}, {}, Edges::mirror}},
      {"mirrored_bspline", {kCubic, {{0, 1}}, {{0, 1}}, {}, Edges::mirror}},
      {"mirrored_free", {kLinear, {}, {}, {{-7.5, 0, 0.5}, {0.5, 9, 0.25}, {6, -6.5, 0.25}}, Edges::mirror}},
      {"mirrored_nearest", {kNearest, {{0, 1}}, {{-2, 0.5}, {3, 0.5}}, {}, Edges::mirror}},
  };
  return kFilters;
}

const std::vector<Case>& cases() {
  using enum AxisRatio;
  static const std::vector<Case> kCases = {
      {"same", same, same, {{{13, 9}, {13, 9}}, {{1, 1}, {1, 1}}}},
      {"half", half, half, {{{26, 18}, {13, 9}}, {{2, 16384}, {1, 8192}}}},
      {"twice", twice, twice, {{{7, 5}, {14, 10}}, {{1, 1}, {2, 2}}}},
      {"fourfold", fourfold, fourfold, {{{7, 5}, {28, 20}}, {{1, 1}, {4, 4}}}},
      {"any_fourfold", any, fourfold, {{{7, 9}, {15, 36}}, {{4096, 1}, {16384, 4}}}},
      {"fourfold_same", fourfold, same, {{{3, 21}, {12, 21}}}},
      {"same_half", same, half, {{{9, 8}, {9, 4}}}},
      {"half_twice", half, twice, {{{10, 3}, {5, 6}}}},
      {"any",
       any,
       any,
       {{{17, 11}, {8, 5}},
        {{5, 5}, {2, 2}},
        {{8, 5}, {17, 11}},
        {{1, 1}, {3, 4}},
        {{11, 7}, {1, 1}},
        {{12, 8}, {6, 4}},
        {{6, 4}, {12, 8}},
        {{6, 4}, {6, 4}}}},
      {"any_half", any, half, {{{7, 8}, {3, 4}}, {{16383, 2}, {8191, 1}}}},
      {"any_twice", any, twice, {{{8191, 1}, {16384, 2}}}},
      {"any_same", any, same, {{{3, 1}, {16384, 1}}, {{16384, 1}, {16383, 1}}}},
      {"same_any", same, any, {{{1, 16384}, {1, 16383}}}},
  };
  return kCases;
}

/// Errors of all samples, sorted: |x − ref|/(Σ|w·I| + 0.01). Σ|w·I| is |ref| but for negative weights, where the
/// formula itself loses digits.
std::vector<double> errors_of(const TestImage& out, const Filter& filter, const TestImage& source) {
  std::vector<double> errors;
  for (int y = 0; y < out.size.height; ++y)
    for (int x = 0; x < out.size.width; ++x)
      for (int c = 0; c < 4; ++c) {
        const auto want = expected(filter, source, out.size, x, y, c);
        errors.push_back(std::abs(out.at(x, y)[c] - want.value) / (want.magnitude + 0.01));
      }
  std::sort(errors.begin(), errors.end());
  return errors;
}

class FilterPixels : public testing::TestWithParam<std::size_t> {
 protected:
  /// Runs every filter at every size of the case.
  template <class Light, class Check>
  void run(bool hardware_filter, int rows, Light light, Check check) {
    const auto& test = cases()[GetParam()];
    KernelCompiler compiler{std::filesystem::path()};
    for (const auto& [name, filter] : filters()) {
      KernelDesc desc;
      desc.filter = filter;
      desc.ratio_x = test.ratio_x;
      desc.ratio_y = test.ratio_y;
      desc.config.hardware_filter = hardware_filter;
      desc.config.rows = rows;
      const auto kernel = compiler.compile(desc);
      ASSERT_TRUE(kernel.ok()) << kernel.error().text();
      for (const auto& sizes : test.sizes) {
        SCOPED_TRACE(testing::Message() << name << " " << sizes.source.width << "x" << sizes.source.height << " to "
                                        << sizes.target.width << "x" << sizes.target.height);
        const TestImage source = light(sizes.source);
        check(errors_of(runner().run(*kernel, {source}, sizes.target), filter, source));
      }
    }
  }
};

constexpr auto kExact = [](const std::vector<double>& errors) {
  EXPECT_LE(errors[errors.size() * 9999 / 10000], 1e-5);
  EXPECT_LE(errors.back(), 5e-4);
};

TEST_P(FilterPixels, EqualTheFormula) {
  run(
      false, 1, [](Size size) { return random_light(size, 7); }, kExact);
}

// At all heights here the last group of rows is cut off somewhere.
TEST_P(FilterPixels, EqualTheFormulaSeveralRowsAtATime) {
  for (const auto& sizes : cases()[GetParam()].sizes)
    if (std::max(sizes.source.width, sizes.target.width) * kMaxRows > 16384) return;  // too wide for a device
  for (const int rows : {2, 4, 8})
    run(
        false, rows, [](Size size) { return random_light(size, 7); }, kExact);
}

TEST_P(FilterPixels, EqualTheFormulaThroughTheSampler) {
  run(true, 1, smooth_light, [](const std::vector<double>& errors) { EXPECT_LE(errors.back(), 5e-4); });
}

INSTANTIATE_TEST_SUITE_P(All, FilterPixels, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& info) { return std::string(cases()[info.param].name); });

TEST(KernelPixels, LongFiltersLoop) {
  KernelDesc desc;
  desc.filter = Filter{};
  desc.filter->x.clear();
  desc.filter->y.clear();
  for (int i = -12; i <= 12; ++i) {
    desc.filter->x.push_back({i * 1.0, 0.04 + 0.001 * i});
    desc.filter->y.push_back({i * 0.75, 0.04 - 0.001 * i});
  }
  for (const bool hardware : {false, true}) {
    desc.config.hardware_filter = hardware;
    KernelCompiler compiler{std::filesystem::path()};
    const auto kernel = compiler.compile(desc);
    ASSERT_TRUE(kernel.ok()) << kernel.error().text();
    const auto source = hardware ? smooth_light({40, 30}) : random_light({40, 30}, 3);
    const auto out = runner().run(*kernel, {source}, {23, 17});
    double worst = 0;
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 23; ++x) {
        const auto want = expected(*desc.filter, source, {23, 17}, x, y, 1);
        worst = std::max(worst, std::abs(out.at(x, y)[1] - want.value) / (want.magnitude + 0.01));
      }
    EXPECT_LE(worst, hardware ? 5e-4 : 1e-5);
  }
}

TEST(KernelPixels, PreludeReadsAreExactAndClamped) {
  ShaderFiles files;
  KernelDesc desc;
  desc.sample = files.stage("s", R"(uniform sampler2D image;
layout(constant_id = 0) const int what = 0;
vec4 sample_at(ivec2 pixel) {
  if (what == 0) return fetch(image, pixel * 2 - 3);
  if (what == 1) return fetch_linear(image, vec2(pixel) * 1.25 - 1.5);
  if (what == 2) return sample_scaled(image, pixel, ivec2(2, -1));
  return vec4(vec2(image_size(image)), vec2(target_size()));
})");
  const Size from{11, 7}, to{9, 10};
  const auto source = random_light(from, 5);
  const auto texel = [&](int x, int y) {
    return source.at(std::clamp(x, 0, from.width - 1), std::clamp(y, 0, from.height - 1));
  };
  const auto linear = [&](double px, double py, int c) {
    const double x = std::floor(px - 0.5), y = std::floor(py - 0.5), fx = px - 0.5 - x, fy = py - 0.5 - y;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    return (texel(i, j)[c] * (1 - fx) + texel(i + 1, j)[c] * fx) * (1 - fy) +
           (texel(i, j + 1)[c] * (1 - fx) + texel(i + 1, j + 1)[c] * fx) * fy;
  };
  KernelCompiler compiler{std::filesystem::path()};
  for (int what = 0; what < 4; ++what) {
    desc.sample->constants["what"] = what;
    const auto kernel = compiler.compile(desc);
    ASSERT_TRUE(kernel.ok()) << kernel.error().text();
    const auto out = runner().run(*kernel, {source}, to);
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x)
        for (int c = 0; c < 4; ++c) {
          double want = 0;
          if (what == 0) want = texel(2 * x - 3, 2 * y - 3)[c];
          if (what == 1) want = linear(std::clamp(x * 1.25 - 1.5, 0.0, 11.0), std::clamp(y * 1.25 - 1.5, 0.0, 7.0), c);
          if (what == 2)
            want = linear((x + 0.5) * from.width / to.width + 2, (y + 0.5) * from.height / to.height - 1, c);
          if (what == 3) want = c == 0 ? from.width : c == 1 ? from.height : c == 2 ? to.width : to.height;
          EXPECT_NEAR(out.at(x, y)[c], want, 1e-5 * (want + 0.01)) << what << " at " << x << "," << y;
        }
  }
}

/// lib/angle.glsl against doubles: turns of both signs, fractions on and beside the quarters.
TEST(KernelPixels, AnglesOfTheLibraryAreExact) {
  ShaderFiles files;
  std::filesystem::create_directories(files.path("lib"));
  std::filesystem::copy_file(std::filesystem::path(AFTERGLOW_PROJECT_FOLDER) / "shaders/lib/angle.glsl",
                             files.path("lib/angle.glsl"));
  KernelDesc desc;
  desc.sample = files.stage("s", R"(#include "lib/angle.glsl"
uniform sampler2D image;
vec4 sample_at(ivec2 pixel) {
  float x = fetch(image, pixel).r;
  return vec4(direction_of(x), tangent(abs(x)), arc_tangent(abs(x)));
})");
  const Size size{4001, 1};
  TestImage source{size, std::vector<float>(4001 * 4)};
  for (int x = 0; x < 4001; ++x) source.at(x, 0)[0] = static_cast<float>((x - 2000) / 160.0);
  const auto kernel = KernelCompiler{std::filesystem::path()}.compile(desc);
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  const auto out = runner().run(*kernel, {source}, size);
  for (int x = 0; x < 4001; ++x) {
    const double turns = source.at(x, 0)[0], angle = 2 * 3.14159265358979323846 * turns;
    EXPECT_NEAR(out.at(x, 0)[0], std::cos(angle), 2e-7) << turns;
    EXPECT_NEAR(out.at(x, 0)[1], std::sin(angle), 2e-7) << turns;
    const double positive = std::abs(turns);
    if (positive < 1.57) {
      const double tan = std::tan(positive);
      EXPECT_NEAR(out.at(x, 0)[2], tan, 3e-7 * tan + 1e-7 * (1 + tan * tan)) << turns;
    }
    EXPECT_NEAR(out.at(x, 0)[3], std::atan(positive), 3e-7) << turns;
  }
}

TEST(KernelPixels, ParametersAndInputsReachTheirStages) {
  ShaderFiles files;
  const std::string text =
      "uniform bool flag;\nuniform vec3 tint;\nuniform int count;\nuniform ivec2 cell;\nlayout(constant_id = 0) const "
      "float gain = 1.0;\n"
      "vec4 apply(vec4 color, vec4 high) {\n  return (flag ? color * vec4(tint, 1.0) * float(count) : color) * gain + "
      "high * float(cell.y);\n}\n";
  KernelDesc desc;
  desc.stages = {files.stage("a", text, {{"gain", 0.5}}), files.stage("b", text)};
  KernelCompiler compiler{std::filesystem::path()};
  const auto kernel = compiler.compile(desc);
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  std::vector<std::byte> block(kernel->block_size);
  const auto set = [&](int stage, const std::string& name, const auto& value) {
    for (const auto& param : kernel->params)
      if (param.stage == stage && param.name == name) std::memcpy(&block[param.offset], &value, sizeof value);
  };
  set(0, "flag", std::int32_t{1});
  set(0, "tint", std::array<float, 3>{2, 3, 4});
  set(0, "count", std::int32_t{3});
  set(0, "cell", std::array<std::int32_t, 2>{100, 5});
  set(1, "flag", std::int32_t{0});
  set(1, "tint", std::array<float, 3>{7, 7, 7});
  set(1, "cell", std::array<std::int32_t, 2>{0, -2});
  const Size size{3, 2};
  const auto a = random_light(size, 1), b = random_light(size, 2), c = random_light(size, 3);
  const auto out = runner().run(*kernel, {a, b, c}, size, block);
  const double tint[] = {2, 3, 4, 1};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      for (int i = 0; i < 4; ++i) {
        const double want = a.at(x, y)[i] * tint[i] * 3 * 0.5 + b.at(x, y)[i] * 5.0 + c.at(x, y)[i] * -2.0;
        const double magnitude = a.at(x, y)[i] * tint[i] * 1.5 + b.at(x, y)[i] * 5.0 + c.at(x, y)[i] * 2.0;
        EXPECT_NEAR(out.at(x, y)[i], want, 1e-6 * magnitude);
      }
}

TEST(KernelPixels, HalfStorageRoundsToNearestEvenAndClamps) {
  TestImage source{{1024, 16}, std::vector<float>(1024 * 16 * 4)};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> exponent(-28.0f, 18.0f), mantissa(1.0f, 2.0f);
  for (auto& value : source.rgba)
    value = std::ldexp(mantissa(random), static_cast<int>(exponent(random))) * (random() % 2 ? 1.0f : -1.0f);
  const float special[] = {0.0f,          -0.0f,         65504.0f,  65519.9f, 65520.0f,        1e30f,
                           -1e30f,        INFINITY,      -INFINITY, 6.1e-5f,  6.103515625e-5f, 5.9604645e-8f,
                           2.9802322e-8f, 2.9802326e-8f, 2049.0f,   2051.0f,  1.00048828125f,  1.00146484375f,
                           6.0996e-5f,    1e-20f};
  std::copy(std::begin(special), std::end(special), source.rgba.begin());
  KernelDesc desc;
  desc.target = KernelTarget::float16;
  KernelCompiler compiler{std::filesystem::path()};
  const auto kernel = compiler.compile(desc);
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  for (const bool half_target : {false, true}) {
    const auto out = runner().run(*kernel, {source}, source.size, {}, half_target);
    int wrong = 0;
    for (std::size_t i = 0; i < source.rgba.size(); ++i) {
      const double value = std::clamp(static_cast<double>(source.rgba[i]), -65504.0, 65504.0);
      int e = 0;
      std::frexp(value, &e);
      const double quantum = std::ldexp(1.0, std::max(e - 11, -24));
      const float want = static_cast<float>(std::nearbyint(value / quantum) * quantum);
      if (out.rgba[i] != want && ++wrong < 10)
        ADD_FAILURE() << source.rgba[i] << " became " << out.rgba[i] << ", not " << want
                      << (half_target ? " in half floats" : "");
    }
    EXPECT_EQ(wrong, 0);
  }
}

TEST(KernelPixels, ValidationIsClean) {
  KernelCompiler compiler{std::filesystem::path()};
  runner().run(*compiler.compile({}), {random_light({4, 4}, 1)}, {4, 4});
  EXPECT_EQ(runner().validation_errors(), 0);
}

}  // namespace
}  // namespace afterglow
