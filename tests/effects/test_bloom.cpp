// SPDX-License-Identifier: MIT
// Bloom, pass by pass: each image against the oracle's pass on the device's own previous image, and against the
// oracle's whole pyramid.
#include <fmt/format.h>

#include "harness.h"
#include "reference/bloom.h"

namespace afterglow {
namespace {

using namespace reference;

std::string lua(const BloomSettings& s) {
  return fmt::format(
      "fx.bloom {{ mode = \"{}\", max_iterations = {}, downscale_limit = {}, threshold = {}, knee = {}, intensity = "
      "{}, scatter = {}, "
      "bicubic_upsampling = {}, fade_fireflies = {}, reference_height = {}, clamp = {}, edges = \"{}\" }}",
      s.mode == BloomMode::additive ? "additive" : "scattering", s.max_iterations, s.downscale_limit, s.threshold,
      s.knee, s.intensity, s.scatter, s.bicubic_upsampling, s.fade_fireflies, s.reference_height, s.clamp,
      s.edges == Edges::mirror ? "mirror" : "stretch");
}

std::string bloom_image(const char* name, std::size_t i) { return fmt::format("bloom.{}[{}]", name, i); }

std::vector<float> interleaved_floats(const DoubleImage& image) {
  const auto doubles = interleaved(image);
  return {doubles.begin(), doubles.end()};
}

/// A picture that is enlarged is filtered at its own size.
bool fades_first(const BloomSettings& s, Size picture) {
  return s.fade_fireflies && s.reference_height > picture.height;
}

/// The image of the light that blooms, at half of the size that the glow is made at.
std::string light_of(const Made& made, const BloomSettings& s) {
  std::string light = "bloom.prefilter";
  if (fades_first(s, made.size))
    for (std::size_t i = 0; made.has(bloom_image("scaled", i)); ++i) light = bloom_image("scaled", i);
  return light;
}

/// Each pass on what the device itself gave to it.
void check_each_pass(const Made& made, const Scene& scene, const BloomSettings& s) {
  auto threshold = BloomThreshold::from_gamma(s.threshold, s.knee);
  threshold.clamp = s.clamp;
  DoubleImage picture = made.has("bloom.hold") ? made.image("bloom.hold") : scene.source;
  const Size full = s.reference_height > 0 ? bloom_scaled_size(picture.size(), s.reference_height) : picture.size();
  const std::string light = light_of(made, s);
  if (fades_first(s, made.size)) {
    EXPECT_TRUE(agrees(made.pixels("bloom.prefilter"), bloom_fade_fireflies(picture, picture.size(), threshold),
                       kFullFloat, kRgb))
        << "fireflies";
    EXPECT_TRUE(agrees(made.pixels(light),
                       bloom_scaled(made.image("bloom.prefilter"), {full.width / 2, full.height / 2}), kFullFloat,
                       kRgb))
        << "scaled";
  } else {
    const DoubleImage scaled = bloom_scaled(picture, full);
    for (std::size_t i = 0; made.has(bloom_image("scaled", i)); ++i) picture = made.image(bloom_image("scaled", i));
    EXPECT_TRUE(agrees(interleaved_floats(picture), scaled, kFullFloat, kRgb)) << "scaled";
    EXPECT_TRUE(
        agrees(made.pixels(light),
               s.fade_fireflies ? bloom_prefilter_fireflies(picture, threshold) : bloom_prefilter(picture, threshold),
               kFullFloat, kRgb))
        << "prefilter";
  }
  std::size_t levels = 0;
  for (std::string before = light; made.has(bloom_image("vertical", levels));
       before = bloom_image("vertical", levels++)) {
    EXPECT_TRUE(agrees(made.pixels(bloom_image("horizontal", levels)), bloom_horizontal(made.image(before), s.edges),
                       kFullFloat, kRgb))
        << "horizontal " << levels;
    EXPECT_TRUE(agrees(made.pixels(bloom_image("vertical", levels)),
                       bloom_vertical(made.image(bloom_image("horizontal", levels)), s.edges), kFullFloat, kRgb))
        << "vertical " << levels;
  }
  std::string low = bloom_image("vertical", levels - 1);
  for (std::size_t i = levels - 1; i-- > 0; low = bloom_image("combine", i)) {
    const auto high = made.image(bloom_image("vertical", i)), up = made.image(bloom_image("up", i));
    EXPECT_TRUE(agrees(made.pixels(bloom_image("up", i)),
                       bloom_up(made.image(low), high.size(), s.bicubic_upsampling, s.edges), kFullFloat, kRgb))
        << "up " << i;
    const auto combined = s.mode == BloomMode::additive ? bloom_add(up, high, 1) : bloom_scatter(up, high, s.scatter);
    EXPECT_TRUE(agrees(made.pixels(bloom_image("combine", i)), combined, kFullFloat, kRgb)) << "combine " << i;
  }
  EXPECT_TRUE(agrees(made.pixels("bloom.up"), bloom_up(made.image(low), made.size, s.bicubic_upsampling, s.edges),
                     kFullFloat, kRgb))
      << "last up";
  const auto up = made.image("bloom.up");
  EXPECT_TRUE(agrees(made.result,
                     s.mode == BloomMode::additive
                         ? bloom_add(up, scene.source, s.intensity)
                         : bloom_scatter_final(up, scene.source, std::min(s.intensity, 0.95), threshold),
                     kFullFloat, kRgba))
      << "final";
}

/// Every image of the device against that of the oracle's own pyramid.
void check_end_to_end(const Made& made, const BloomSettings& settings, const BloomImages& expected) {
  EXPECT_TRUE(agrees(made.pixels(light_of(made, settings)), expected.prefilter, kFullFloat, kRgb));
  for (std::size_t i = 0; i < expected.vertical.size(); ++i) {
    EXPECT_TRUE(agrees(made.pixels(bloom_image("horizontal", i)), expected.horizontal[i], kFullFloat, kRgb))
        << "horizontal " << i;
    EXPECT_TRUE(agrees(made.pixels(bloom_image("vertical", i)), expected.vertical[i], kFullFloat, kRgb))
        << "vertical " << i;
  }
  EXPECT_FALSE(made.has(bloom_image("vertical", expected.vertical.size()))) << "too many levels";
  for (std::size_t i = 0; i < expected.combine.size(); ++i) {
    EXPECT_TRUE(agrees(made.pixels(bloom_image("up", i)), expected.up[i], kFullFloat, kRgb)) << "up " << i;
    EXPECT_TRUE(agrees(made.pixels(bloom_image("combine", i)), expected.combine[i], kFullFloat, kRgb))
        << "combine " << i;
  }
  EXPECT_TRUE(agrees(made.result, expected.result, kFullFloat, kRgba));
}

void check(const Scene& scene, const BloomSettings& settings) {
  SCOPED_TRACE(scene.name + ": " + lua(settings));
  const auto expected = bloom(scene.source, settings);
  const Made made = run_stack(lua(settings), scene, Way::plain);
  ASSERT_EQ(made.ran(), expected.ran);
  EXPECT_TRUE(alpha_is_kept(made, scene));
  if (!expected.ran) {
    ASSERT_EQ(made.graph.skipped.size(), 1u);
    EXPECT_THAT(made.graph.skipped[0].reason, testing::HasSubstr("too small"));
    return;
  }
  check_each_pass(made, scene, settings);
  check_end_to_end(made, settings, expected);
  const Made fused = run_stack(lua(settings), scene, Way::fused);
  EXPECT_TRUE(agrees(fused.result, from_floats(made.result.data(), made.size, 4), kFused, kRgba)) << "fused";
}

class Bloom : public Effects, public testing::WithParamInterface<Size> {};

TEST_P(Bloom, EveryPassAgrees) {
  // Settings that go with each combination of the three switches; limits and iteration counts take turns.
  static constexpr struct {
    int iterations, limit;
    double threshold, knee, intensity, scatter;
  } kTurns[] = {{16, 1, 1.0, 0.5, 0.2, 0.7},
                {3, 1, 0.5, 1.0, 1.5, 0.3},
                {16, 2, 0.0, 0.0, 0.6, 0.95},
                {1, 1, 1.5, 0.2, 0.9, 0.05}};
  int turn = 0;
  for (const auto mode : {BloomMode::additive, BloomMode::scattering})
    for (const bool bicubic : {true, false})
      for (const bool fireflies : {false, true}) {
        const auto& t = kTurns[turn++ % 4];
        check(random_scene(GetParam(), 1 + static_cast<unsigned>(turn), turn % 2 == 0),
              {mode, t.iterations, t.limit, t.threshold, t.knee, t.intensity, t.scatter, bicubic, fireflies});
      }
}
INSTANTIATE_TEST_SUITE_P(Sizes, Bloom, testing::ValuesIn(kSizes),
                         [](const auto& info) { return fmt::format("{}x{}", info.param.width, info.param.height); });

TEST_F(Effects, BloomOfARealFrameAgrees) {
  for (const auto mode : {BloomMode::additive, BloomMode::scattering}) {
    check(neon_scene({320, 180}, 200, 120), {.mode = mode, .fade_fireflies = true});
    check(neon_scene({201, 113}, 901, 333), {.mode = mode, .threshold = 0.8, .knee = 0.7, .intensity = 0.5});
  }
}

TEST_F(Effects, BloomOfAnExtremelyLongPictureAgrees) {
  check(random_scene({1021, 9}, 5), {.downscale_limit = 1});
  check(random_scene({4, 700}, 6), {.mode = BloomMode::scattering, .downscale_limit = 1});
}

TEST_F(Effects, BloomOfAMirroredPictureAgrees) {
  for (const Size size : kSizes)
    check(random_scene(size, 15), {.mode = BloomMode::scattering, .downscale_limit = 1, .edges = Edges::mirror});
  check(random_scene({101, 57}, 16, true), {.bicubic_upsampling = false, .edges = Edges::mirror});
}

/// A lamp at an edge glows as one in the middle does.
TEST_F(Effects, MirroredEdgesKeepTheSumOfAGlow) {
  const auto added = [](int x, int y, const char* edges) {
    Scene scene{"lamp", DoubleImage(256, 128, Rgba(0, 0, 0, 1)), {}, {}};
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) scene.source.at(x + i, y + j) = Rgba(40, 40, 40, 1);
    double sum = -40 * 16;
    const auto made =
        run_stack(fmt::format("fx.bloom {{ threshold = 0, edges = \"{}\" }}", edges), scene, Way::fused).result;
    for (std::size_t i = 0; i < made.size(); i += 4) sum += made[i];
    return sum;
  };
  const double middle = added(124, 60, "mirror");
  EXPECT_NEAR(added(124, 60, "stretch"), middle, 0.15 * middle);
  for (const auto& [x, y] : {std::pair(0, 60), {252, 60}, {124, 0}, {0, 0}, {252, 124}})
    EXPECT_NEAR(added(x, y, "mirror"), middle, 1e-4 * middle) << x << "," << y;
  EXPECT_GT(added(0, 0, "stretch"), 2 * middle);
}

TEST_F(Effects, BloomAtAReferenceHeightAgrees) {
  // Larger and smaller than the picture, whole and other ratios, the picture's own, and less than the levels need.
  for (const int height : {30, 45, 67, 90, 100, 135, 200, 4})
    for (const bool fireflies : {false, true})
      check(random_scene({240, 135}, 11, true), {.fade_fireflies = fireflies, .reference_height = height});
  check(random_scene({101, 57}, 12), {.mode = BloomMode::scattering, .downscale_limit = 1, .reference_height = 20});
  check(random_scene({51, 108}, 13), {.downscale_limit = 1, .reference_height = 54});  // half as high, to an odd width
}

/// Of a picture that is smaller than the stack's, single pixels are not enlarged before they are looked for.
TEST_F(Effects, BloomFadesFirefliesOfSmallPictures) {
  for (const int side : {1, 2}) {
    Scene scene{"firefly", DoubleImage(256, 144, Rgba(0.05, 0.05, 0.05, 1)), {}, {}};
    for (int i = 0; i < side * side; ++i) scene.source.at(128 + i % side, 72 + i / side) = Rgba(3000, 3000, 3000, 1);
    const auto glow = [&](const char* fading) {
      const auto made = run_stack(fmt::format("fx.bloom {{ mode = \"scattering\", reference_height = 432{} }}", fading),
                                  scene, Way::fused);
      return made.result[4 * (std::size_t{256} * 72 + 140)] - 0.05f;
    };
    EXPECT_GT(glow(""), 0.1f);
    EXPECT_LT(glow(", fade_fireflies = true"), 1e-3f);
  }
}

TEST_F(Effects, BloomHoldsWildPixels) {
  for (const auto mode : {BloomMode::additive, BloomMode::scattering})
    for (const bool fireflies : {false, true})
      check(random_scene({101, 57}, 14, true), {.mode = mode, .fade_fireflies = fireflies, .clamp = 2.5});
  Scene scene{"wild", DoubleImage(256, 144, Rgba(0.2, 0.2, 0.2, 1)), {}, {}};
  scene.source.at(128, 72) = Rgba(65504, 30000, 0, 1);
  const auto brightest_far_away = [&](const char* entry) {
    const auto made = run_stack(entry, scene, Way::fused).result;
    return made[4 * (static_cast<std::size_t>(256) * 30 + 30)];
  };
  EXPECT_GT(brightest_far_away("fx.bloom {}"), 0.5);
  EXPECT_NEAR(brightest_far_away("fx.bloom { clamp = 50 }"), 0.2, 0.01);
}

TEST_F(Effects, TheReferenceHeightOfAPictureChangesNothing) {
  const Scene scene = random_scene({96, 54}, 13);
  EXPECT_EQ(run_stack("fx.bloom { reference_height = 54 }", scene, Way::fused).result,
            run_stack("fx.bloom {}", scene, Way::fused).result);
}

TEST_F(Effects, BloomSkipsAndSaysWhy) {
  const auto scene = random_scene({64, 64}, 3);
  const auto reason = [&](const char* entries) {
    const Made made = run_stack(entries, scene, Way::plain);
    EXPECT_FALSE(made.ran()) << entries;
    return made.graph.skipped.empty() ? "" : made.graph.skipped[0].reason;
  };
  EXPECT_EQ(reason("fx.bloom { intensity = 0 }"), "intensity is 0");
  EXPECT_EQ(reason("fx.bloom { max_iterations = 0 }"), "max_iterations is 0");
  EXPECT_EQ(reason("fx.bloom { downscale_limit = 17 }"),
            "the picture is too small: 64x64, downscale_limit 17 needs 68 on each side");
  EXPECT_TRUE(run_stack("fx.bloom { downscale_limit = 16 }", scene, Way::plain).ran());
}

TEST_F(Effects, ScatteringKeepsAPictureOfOneColour) {
  Scene scene{"constant", DoubleImage(50, 31, Rgba(4, 2, 0.5, 0.25)), {}, {}};
  const Made made = run_stack("fx.bloom { mode = \"scattering\", intensity = 0.95, scatter = 0.7 }", scene, Way::fused);
  EXPECT_TRUE(agrees(made.result, scene.source, kFullFloat, kRgba));
}

}  // namespace
}  // namespace afterglow
