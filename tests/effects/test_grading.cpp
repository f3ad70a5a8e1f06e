// SPDX-License-Identifier: MIT
// Colour grading: white balance, channel mixer, split toning, shadows/midtones/highlights, lift/gamma/gain.
#include <fmt/format.h>

#include "cases.h"
#include "files.h"
#include "reference/color.h"
#include "reference/grading.h"
#include "reference/tone_mapping.h"

namespace afterglow {
namespace {

using namespace reference;

std::string text(const Rgb& c) { return fmt::format("{{ {}, {}, {} }}", c.r, c.g, c.b); }

EffectCase balanced(const WhiteBalance& v) {
  return {
      fmt::format("fx.white_balance {{ kelvin = {}, temperature = {}, tint = {} }}", v.kelvin, v.temperature, v.tint),
      [=](const Scene& s) { return white_balance(s.source, v); }};
}

EffectCase mixed(const ChannelMix& m) {
  static constexpr const char* kNames[] = {"red", "green", "blue"};
  std::string settings;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) settings += fmt::format("{}_out_{}_in = {}, ", kNames[i], kNames[j], m[i][j]);
  return {"fx.channel_mixer { " + settings + "}", [=](const Scene& s) { return channel_mixer(s.source, m); }};
}

EffectCase toned(const SplitToning& t) {
  const auto linear = [](const Rgb& c) { return Rgb(srgb_to_linear(c.r), srgb_to_linear(c.g), srgb_to_linear(c.b)); };
  return {fmt::format("fx.split_toning {{ shadows = {}, highlights = {}, balance = {} }}", text(linear(t.shadows)),
                      text(linear(t.highlights)), t.balance),
          [=](const Scene& s) { return split_toning(s.source, t); }};
}

EffectCase scaled(const ShadowsMidtonesHighlights& v) {
  return {fmt::format("fx.shadows_midtones_highlights {{ shadows = {}, shadows_offset = {}, midtones = {}, "
                      "midtones_offset = {}, highlights = {}, highlights_offset = {}, shadows_start = {}, shadows_end "
                      "= {}, highlights_start = {}, highlights_end = {} }}",
                      text(v.shadows), v.shadows_offset, text(v.midtones), v.midtones_offset, text(v.highlights),
                      v.highlights_offset, v.shadows_start, v.shadows_end, v.highlights_start, v.highlights_end),
          [=](const Scene& s) { return shadows_midtones_highlights(s.source, v); }};
}

EffectCase graded(const LiftGammaGain& v) {
  return {fmt::format("fx.lift_gamma_gain {{ lift = {}, lift_offset = {}, gamma = {}, gamma_offset = {}, gain = {}, "
                      "gain_offset = {} }}",
                      text(v.lift), v.lift_offset, text(v.gamma), v.gamma_offset, text(v.gain), v.gain_offset),
          [=](const Scene& s) { return lift_gamma_gain(s.source, v); }};
}

TEST_F(Effects, WhiteBalanceAgrees) {
  agree_everywhere({balanced({.temperature = 30}), balanced({.temperature = -100}),
                    balanced({.temperature = 100, .tint = 100}), balanced({.temperature = 12, .tint = -60}),
                    balanced({.kelvin = 3200}), balanced({.kelvin = 2000, .temperature = -20}),
                    balanced({.kelvin = 25000, .tint = 10}), balanced({.kelvin = 6505}),
                    balanced({.kelvin = 2000, .temperature = -100, .tint = 100})});
  expect_skipped("fx.white_balance {}", "all settings are neutral");
}

TEST_F(Effects, WarmWhiteBalanceIsWarm) {
  const Scene grey{"grey", DoubleImage(1, 1, Rgba(0.5, 0.5, 0.5, 1)), {}, {}};
  const auto warm = run_stack("fx.white_balance { temperature = 50 }", grey, Way::plain).result;
  EXPECT_GT(warm[0], warm[1]);
  EXPECT_GT(warm[1], warm[2]);
  const auto green = run_stack("fx.white_balance { tint = -50 }", grey, Way::plain).result;
  EXPECT_GT(green[1], green[0]);
}

TEST_F(Effects, KelvinsAreThoseOfTabulatedLights) {
  // Illuminants A, D50, D55, D65 and D75 of CIE 15, with the temperatures of today's constants; a candle by Planck's
  // law.
  const struct {
    double kelvin, x, y;
  } kLights[] = {{2856, 0.44758, 0.40745}, {5003, 0.34567, 0.35850}, {5503, 0.33242, 0.34743},
                 {6504, 0.31271, 0.32902}, {7504, 0.29902, 0.31485}, {2000, 0.52669, 0.41331}};
  for (const auto& light : kLights) {
    const glm::dvec2 white = white_of_kelvin(light.kelvin);
    EXPECT_NEAR(white.x, light.x, 6e-4) << light.kelvin;
    EXPECT_NEAR(white.y, light.y, 6e-4) << light.kelvin;
    // What such a light makes of white becomes grey.
    const Rgb xyz(light.x / light.y, 1, (1 - light.x - light.y) / light.y);
    const Rgb lit = 0.3 * Rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                              -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                              0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    const Scene scene{"lit", DoubleImage(1, 1, Rgba(lit, 1)), {}, {}};
    const auto grey = run_stack(balanced({.kelvin = light.kelvin, .tint = 1e-9}).entries, scene, Way::plain).result;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(grey[static_cast<std::size_t>(c)], 0.3, 4e-3) << light.kelvin;
  }
  double before = 1;
  for (double kelvin = 2000; kelvin <= 25000; kelvin *= 1.002) {
    const double x = white_of_kelvin(kelvin).x;
    EXPECT_LT(x, before) << kelvin;
    EXPECT_GT(x, before - 1e-3 - (kelvin < 2001 ? 1 : 0)) << "no jumps at " << kelvin;
    before = x;
  }
}

TEST_F(Effects, ChannelMixerAgrees) {
  agree_everywhere({mixed({{{0, 100, 0}, {0, 0, 100}, {100, 0, 0}}}),
                    mixed({{{30, 59, 11}, {30, 59, 11}, {30, 59, 11}}}),
                    mixed({{{140, -20, -20}, {0, 100, 0}, {-50, 0, 200}}})});
  expect_skipped("fx.channel_mixer {}", "all settings are neutral");
}

TEST_F(Effects, SplitToningAgrees) {
  agree_everywhere({toned({.shadows = {0.2, 0.4, 0.7}, .highlights = {0.8, 0.6, 0.3}}),
                    toned({.shadows = {0.5, 0.5, 0.8}, .balance = 60}),
                    toned({.highlights = {1, 0, 0.4}, .balance = -30}),
                    toned({.shadows = {0.4981, 0.5, 0.5}, .highlights = {0.5, 0.5015, 0.5}})});  // nearly grey
  expect_skipped("fx.split_toning {}", "both tints are grey");
  expect_skipped("fx.split_toning { shadows = \"#808080\", highlights = \"#808080\" }", "both tints are grey");
}

TEST_F(Effects, ShadowsMidtonesHighlightsAgree) {
  agree_everywhere({scaled({.shadows = {0.7, 0.9, 1.3}, .highlights = {1.2, 1.05, 0.8}}),
                    scaled({.shadows_offset = 0.2, .midtones_offset = -0.3, .highlights_offset = -1}),
                    scaled({.midtones = {0, 2, 1},
                            .shadows_start = 0.1,
                            .shadows_end = 0.9,
                            .highlights_start = 0.4,
                            .highlights_end = 8})});
  expect_skipped("fx.shadows_midtones_highlights {}", "all factors are 1");
  expect_skipped("fx.shadows_midtones_highlights { shadows_end = 0.5 }", "all factors are 1");
}

TEST_F(Effects, LiftGammaGainAgree) {
  agree_everywhere({graded({.lift = {0.9, 1, 1.3}, .gamma = {1.1, 1, 0.9}, .gain = {1.2, 1, 0.7}}),
                    graded({.lift_offset = 0.05}), graded({.gamma_offset = 0.4, .gain_offset = -0.3}),
                    graded({.gamma_offset = -0.5, .gain_offset = 0.8})});
  expect_skipped("fx.lift_gamma_gain {}", "all settings are neutral");
  expect_skipped("fx.lift_gamma_gain { gain = { 0.5, 0.5, 0.5 } }",
                 "all settings are neutral");  // a grey is the middle
}

EffectCase listed(const Cdl& v) {
  return {fmt::format("fx.cdl {{ slope = {}, offset = {}, power = {}, saturation = {} }}", text(v.slope),
                      text(v.offset), text(v.power), v.saturation),
          [=](const Scene& s) { return cdl(s.source, v); }};
}

TEST_F(Effects, CdlAgrees) {
  agree_everywhere(
      {listed({.slope = {1.2, 0.9, 1.05}, .offset = {0.01, 0.02, 0}, .saturation = 0.8}),
       listed({.offset = {0.05, 0.03, 0.1}, .power = {0.8, 1, 1.3}, .saturation = 1.4}),
       listed({.slope = {1, 2, 0}, .offset = {-0.02, -0.2, 0}, .power = {1.5, 1, 2}}), listed({.saturation = 0})},
      kSteep);
  expect_skipped("fx.cdl {}", "all settings are neutral");
}

/// Two corrections in one file.
constexpr const char* kCorrections = R"(<?xml version="1.0" encoding="UTF-8"?>
<ColorCorrectionCollection xmlns="urn:ASC:CDL:v1.2">
  <ColorCorrection id="day">
    <SOPNode><Slope>1.2 1 0.75</Slope><Offset>0.125 0 0.25</Offset><Power>1 1.5 1</Power></SOPNode>
    <SatNode><Saturation>1.5</Saturation></SatNode>
  </ColorCorrection>
  <ColorCorrection id="night">
    <SOPNode><Slope>0.5 0.625 1</Slope><Offset>0 0 0.03125</Offset><Power>1 1 1.25</Power></SOPNode>
  </ColorCorrection>
</ColorCorrectionCollection>
)";

TEST_F(Effects, CdlReadsFiles) {
  write_test_file("grade.ccc", kCorrections);
  const Cdl day{.slope = {1.2, 1, 0.75}, .offset = {0.125, 0, 0.25}, .power = {1, 1.5, 1}, .saturation = 1.5};
  const Cdl night{.slope = {0.5, 0.625, 1}, .offset = {0, 0, 0.03125}, .power = {1, 1, 1.25}};
  const auto scene = random_scene({40, 30}, 94);
  const auto made = [&](const std::string& entry) { return run_stack(entry, scene, Way::fused).result; };
  EXPECT_TRUE(agrees(made("fx.cdl { file = \"grade.ccc\" }"), cdl(scene.source, day), kSteep.full, kRgb));
  for (const char* id : {"night", "1"})
    EXPECT_TRUE(agrees(made(fmt::format("fx.cdl {{ file = \"grade.ccc\", correction = \"{}\" }}", id)),
                       cdl(scene.source, night), kSteep.full, kRgb))
        << id;
  EXPECT_THAT(build_error("fx.cdl { file = \"grade.ccc\", correction = \"dusk\" }", scene), testing::HasSubstr("dusk"));
  const Cdl behind{.slope = {1, 2, 1}, .saturation = 0.5};
  EXPECT_TRUE(
      agrees(made("fx.cdl { file = \"grade.ccc\", correction = \"night\", slope = { 1, 2, 1 }, saturation = 0.5 }"),
             cdl(cdl(scene.source, night), behind), kSteep.full, kRgb));
}

/// The same numbers in a file and in settings, on colours that offset takes below black.
TEST_F(Effects, CdlOfAFileIsThatOfSettings) {
  const std::string correction =
      "<ColorCorrection id=\"x\"><SOPNode><Slope>1.2 1 0.8</Slope><Offset>-0.05 0.01 -0.3</Offset>"
      "<Power>1.1 0.9 1</Power></SOPNode><SatNode><Saturation>1.7</Saturation></SatNode></ColorCorrection>";
  const std::string other =
      "<ColorCorrection id=\"y\"><SOPNode><Slope>1 1 1</Slope><Offset>0 0 0</Offset>"
      "<Power>1 1 1</Power></SOPNode></ColorCorrection>";
  write_test_file("a.cc", correction);
  write_test_file("a.ccc", "<ColorCorrectionCollection xmlns=\"urn:ASC:CDL:v1.2\">" + other + correction +
                               "</ColorCorrectionCollection>");
  write_test_file("a.cdl", "<ColorDecisionList xmlns=\"urn:ASC:CDL:v1.01\"><ColorDecision>" + correction +
                               "</ColorDecision></ColorDecisionList>");
  auto scene = random_scene({40, 30}, 95);
  scene.source.pixels[0] = {0.001, 1.4, 1.9, 1};
  scene.source.pixels[1] = {0, 0, 0, 1};
  scene.source = in_floats(scene.source);
  const auto made = [&](const std::string& entry) { return run_stack(entry, scene, Way::fused).result; };
  const auto by_settings = made(
      "fx.cdl { slope = { 1.2, 1, 0.8 }, offset = { -0.05, 0.01, -0.3 }, power = { 1.1, 0.9, 1 }, saturation = 1.7 }");
  for (const char* file : {"file = \"a.cc\"", "file = \"a.ccc\", correction = \"x\"", "file = \"a.cdl\""}) {
    const auto by_file = made(fmt::format("fx.cdl {{ {} }}", file));
    for (std::size_t i = 0; i < by_file.size(); ++i)
      ASSERT_NEAR(by_file[i], by_settings[i], 1e-6 * std::max(1.0F, std::abs(by_settings[i]))) << file << ", " << i;
  }
  write_test_file("cube.cc", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
  EXPECT_THAT(build_error("fx.cdl { file = \"cube.cc\" }", scene),
              testing::HasSubstr("file = \"cube.cc\" holds a table; effect 'lut' reads those"));
}

EffectCase curved(const Curves& v) {
  static constexpr const char* kPoints[] = {"blacks", "shadows", "midtones", "highlights", "whites"};
  static constexpr const char* kChannels[] = {"red", "green", "blue"};
  static constexpr const char* kHues[] = {"reds", "yellows", "greens", "cyans", "blues", "magentas"};
  std::string settings = fmt::format("by = \"{}\"", v.by_luminance ? "luminance" : "channels");
  for (int i = 0; i < 5; ++i) settings += fmt::format(", {} = {}", kPoints[i], v.master[i]);
  for (int i = 0; i < 3; ++i)
    settings += fmt::format(", {} = {}", kChannels[i], text({v.channels[i][0], v.channels[i][1], v.channels[i][2]}));
  for (int i = 0; i < 6; ++i) settings += fmt::format(", {} = {}", kHues[i], text(v.hues[i]));
  return {"fx.curves { " + settings + " }", [=](const Scene& s) { return curves(s.source, v); }};
}

TEST_F(Effects, CurvesAgree) {
  agree_everywhere(
      {curved({.master = {-1, -0.5, 0, 0.5, 0.25}}), curved({.by_luminance = true, .master = {2, 1, 0.5, -0.5, -3}}),
       curved({.master = {0, 0, 0, 4, -4}, .channels = {{{0.5, 0, -0.5}, {0, 0.2, 0}, {-1, 1, -1}}}}),
       curved({.by_luminance = true,
               .master = {0, -0.3, 0, 0.3, 0},
               .channels = {{{0.1, 0, 0}, {}, {0, 0, 0.4}}},
               .hues = {Rgb(-20, 30, 10), Rgb(50, 0, 0), Rgb(0, -100, -50), Rgb(), Rgb(40, 50, -30),
                        Rgb(-100, 100, 100)}}),
       curved({.hues = {Rgb(100, 0, 0), Rgb(-100, 0, 0), Rgb(0, 0, 100), Rgb(0, 0, -100), Rgb(0, 100, 0),
                        Rgb(0, -100, 0)}})},
      kSteep);
  expect_skipped("fx.curves {}", "all points are 0");
}

/// Middle grey and what lies at a point get that point's gain; black stays black.
TEST_F(Effects, CurvesGoThroughTheirPoints) {
  Scene greys{"greys", DoubleImage(6, 1, Rgba(0, 0, 0, 1)), {}, {}};
  const double stops[] = {-6, -3, 0, 3, 6}, gains[] = {-1, 1, 0.5, -2, 3};
  for (int i = 0; i < 5; ++i) greys.source.at(i, 0) = Rgba(Rgb(0.18 * std::exp2(stops[i])), 1);
  const char* entry =
      "fx.curves {{ by = \"{}\", blacks = -1, shadows = 1, midtones = 0.5, highlights = -2, whites = 3 }}";
  for (const char* by : {"channels", "luminance"}) {
    const auto made = run_stack(fmt::format(fmt::runtime(entry), by), greys, Way::plain).result;
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(made[static_cast<std::size_t>(i) * 4] / (0.18 * std::exp2(stops[i])), std::exp2(gains[i]), 1e-4)
          << by << i;
    EXPECT_EQ(made[20], 0);
  }
}

/// HSV without an ε: where two channels are equal, a last digit decides from which of them a hue is counted.
TEST_F(Effects, HuesDoNotJumpAndAreThoseOfEveryExposure) {
  constexpr int kColours = 24;
  Scene ties{"ties", DoubleImage(kColours, 3), {}, {}};
  for (int x = 0; x < kColours; ++x) {
    const float a = 0.03F * static_cast<float>(1 + x), b = 0.02F * static_cast<float>(kColours - x);
    Rgb colour(a, a, b);
    colour = x % 3 == 0 ? colour : x % 3 == 1 ? Rgb(colour.z, colour.x, colour.y) : Rgb(colour.y, colour.z, colour.x);
    ties.source.at(x, 0) = Rgba(colour, 1);
    for (int i = 2; i >= 0 && colour == Rgb(ties.source.at(x, 0)); --i)  // the last of both: then the other is first
      if (colour[i] == static_cast<double>(a)) colour[i] = static_cast<double>(std::nextafter(a, 2.0F));
    ties.source.at(x, 1) = Rgba(colour, 1);
    ties.source.at(x, 2) = Rgba(Rgb(ties.source.at(x, 0)) / 4096.0, 1);
  }
  const auto made = run_stack(
      "fx.curves { reds = { 40, 20, 10 }, yellows = { -60, 0, 30 }, greens = { 100, 10, 0 }, cyans = { 0, 40, -20 }, "
      "blues = { -80, 0, 0 }, magentas = { 20, -30, 10 } }",
      ties, Way::plain);
  for (std::size_t x = 0; x < kColours; ++x)
    for (std::size_t i = 0; i < 3; ++i) {
      const float value = made.result[x * 4 + i];
      EXPECT_NEAR(made.result[(kColours + x) * 4 + i], value, 2e-6F * (value + 0.1F)) << x << ' ' << i;
      EXPECT_NEAR(made.result[(2 * kColours + x) * 4 + i] * 4096, value, 2e-6F * (value + 0.1F)) << x << ' ' << i;
    }
}

TEST_F(Effects, AWholeGradeIsOneKernel) {
  const char* entries =
      "fx.vignette {}, fx.white_balance { temperature = 20 }, fx.split_toning { shadows = \"#305080\" }, "
      "fx.channel_mixer { red_out_green_in = 10 }, fx.shadows_midtones_highlights { shadows_offset = 0.05 }, "
      "fx.lift_gamma_gain { gamma_offset = 0.1 }, fx.tone_mapping { mode = \"neutral\" }, "
      "fx.color_adjustments { contrast = 10, saturation = 10 }, fx.film_grain { size = 1.5 }";
  const auto scene = neon_scene({160, 90}, 560, 330);
  const Made plain = run_stack(entries, scene, Way::plain), fused = run_stack(entries, scene, Way::fused);
  EXPECT_EQ(plain.kernels, 9u);
  EXPECT_EQ(fused.kernels, 1u);
  EXPECT_TRUE(agrees(fused.result, from_floats(plain.result.data(), plain.size, 4), kFused, kRgba));
}

}  // namespace
}  // namespace afterglow
