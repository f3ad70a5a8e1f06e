// SPDX-License-Identifier: MIT
// Soft edges: effects that bend colour see it without its alpha, whatever that is (math.md §19).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "cases.h"
#include "core/file.h"
#include "core/paths.h"
#include "files.h"
#include "reference/tone_mapping.h"
#include "session/session.h"

namespace afterglow {
namespace {

using namespace reference;

/// Colours from dark to far above white by row, and an alpha ramp from almost nothing to 1 by column.
struct Ramp {
  Scene opaque, soft;
  explicit Ramp(Size size = {64, 24}) {
    opaque.name = "opaque";
    soft.name = "soft";
    opaque.source = soft.source = DoubleImage(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const double light = 0.01 * std::exp2(y * 0.5), a = std::exp2(-6.0 * (size.width - 1 - x) / (size.width - 1));
        const Rgb color = light * Rgb(1, 0.4 + 0.02 * y, 1.5 - 0.05 * y);
        opaque.source.at(x, y) = Rgba(color, 1);
        soft.source.at(x, y) = Rgba(color * a, a);
      }
    opaque.source = in_floats(opaque.source);
    soft.source = in_floats(soft.source);
  }
};

/// Largest difference of straight colours, relative where they are above 0.01.
double difference(const std::vector<float>& soft, const std::vector<float>& opaque, const Scene& scene) {
  double worst = 0;
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double a = scene.source.pixels[i].a, wanted = opaque[4 * i + c];
      worst = std::max(worst, std::abs(soft[4 * i + c] / a - wanted) / (std::abs(wanted) + 0.01));
    }
  return worst;
}

/// The largest difference that was seen.
double expect_straight(const std::string& entries, double tolerance = 1e-5) {
  const Ramp ramp;
  double worst = 0;
  for (const Way way : {Way::plain, Way::fused}) {
    const Made soft = run_stack(entries, ramp.soft, way), opaque = run_stack(entries, ramp.opaque, way);
    EXPECT_TRUE(soft.ran()) << entries;
    if (!soft.ran()) return worst;
    worst = std::max(worst, difference(soft.result, opaque.result, ramp.soft));
    EXPECT_TRUE(alpha_is_kept(soft, ramp.soft)) << entries;
  }
  EXPECT_LE(worst, tolerance) << entries;
  return worst;
}

/// Settings with which each effect that asks for straight colour has something to do.
const std::map<std::string, std::vector<std::string>>& bending() {
  static const std::map<std::string, std::vector<std::string>> all{
      {"color_adjustments",
       {"contrast = 35", "post_exposure = 0.5, contrast = -20, hue_shift = 40, saturation = 30", "saturation = -60"}},
      {"cdl", {"slope = { 1.3, 1, 0.8 }, power = { 1.2, 1, 0.9 }, saturation = 1.2"}},
      {"curves",
       {"blacks = -1, highlights = 0.7",
        "by = \"luminance\", whites = -1, reds = { 20, 30, 40 }, blues = { -30, 50, 0 }"}},
      {"film_grain", {"intensity = 0.6", "intensity = 0.6, size = 2.5"}},
      {"lift_gamma_gain",
       {"gamma_offset = 0.3", "lift_offset = 0.1, gain_offset = 0.2, gamma = { 1, 0.9, 0.8 }", "lift_offset = -0.02"}},
      {"lut", {"file = \"bent.cube\"", "file = \"bent.cube\", input = \"linear\", intensity = 0.5"}},
      {"ocio_display", {"config = \"ocio/aces.ocio\""}},
      {"ocio_transform", {"config = \"ocio/aces.ocio\", to = \"ACEScct\""}},
      {"shadows_midtones_highlights", {"shadows_offset = -0.4, highlights_offset = 0.2"}},
      {"split_toning", {"shadows = \"#204080\", highlights = \"#c09040\", balance = 20"}},
      {"tone_mapping",
       {"mode = \"aces\"", "mode = \"neutral\"", "mode = \"reinhard\"", "mode = \"reinhard_extended\"",
        "mode = \"agx\"", "mode = \"khronos_neutral\"", "mode = \"hable\"", "mode = \"gt\""}},
  };
  return all;
}

void write_bent_cube() {
  std::string text = "LUT_3D_SIZE 3\n";
  for (int i = 0; i < 27; ++i)
    text += fmt::format("{:.3f} {:.3f} {:.3f}\n", std::sqrt(i % 3 * 0.5), i / 3 % 3 * 0.45 + 0.1, i / 9 * i / 9 * 0.25);
  write_test_file("bent.cube", text);
}

/// docs/alpha.md has a row for each effect of `rows`; AFTERGLOW_UPDATE=1 writes it anew.
void keep_table(const std::map<std::string, std::pair<std::size_t, double>>& rows) {
  const std::filesystem::path file = AFTERGLOW_PROJECT_FOLDER "/docs/alpha.md";
  const std::string head = "| effect | settings tried | largest difference |\n|---|---|---|\n";
  auto text = read_file(file);
  ASSERT_TRUE(text) << text.error().text();
  if (std::getenv("AFTERGLOW_UPDATE")) {
    *text = text->substr(0, text->find(head)) + head;
    for (const auto& [effect, row] : rows)
      *text += fmt::format("| `{}` | {} | {:.1e} |\n", effect, row.first, row.second);
    ASSERT_TRUE(write_file_atomically(file, *text));
  }
  for (const auto& [effect, row] : rows)
    EXPECT_NE(text->find(fmt::format("\n| `{}` | {} | ", effect, row.first)), std::string::npos)
        << "AFTERGLOW_UPDATE=1 ctest -R SoftEdgesKeepTheirColourThroughEveryEffect";
}

TEST_F(Effects, SoftEdgesKeepTheirColourThroughEveryEffectThatBendsIt) {
  write_bent_cube();
  std::map<std::string, std::pair<std::size_t, double>> rows;
  Diagnostics diagnostics;
  const auto effects = list_effects(search_path_for({}, {}), diagnostics);
  ASSERT_TRUE(effects);
  for (const auto& effect : *effects) {
    if (!effect.straight) continue;
    const auto known = bending().find(effect.name);
    // A new one: at least as it comes.
    const std::vector<std::string> tried = known == bending().end() ? std::vector<std::string>{""} : known->second;
    for (const auto& settings : tried)
      rows[effect.name].second =
          std::max(rows[effect.name].second, expect_straight(fmt::format("fx.{} {{ {} }}", effect.name, settings)));
    rows[effect.name].first = tried.size();
  }
  keep_table(rows);
}

TEST_F(Effects, SoftEdgesKeepTheirColourThroughEffectsThatScaleIt) {
  for (const char* entry :
       {"fx.channel_mixer { red_out_green_in = 30, blue_out_red_in = -20 }", "fx.white_balance { temperature = 30 }",
        "fx.color_blit { intensity = 0.7 }", "fx.vignette { intensity = 0.5 }"})
    expect_straight(entry);
}

TEST_F(Effects, SoftEdgesKeepTheirColourThroughWholeStacks) {
  expect_straight(
      "fx.color_adjustments { contrast = 20 }, fx.split_toning { shadows = \"#304060\" }, fx.white_balance { "
      "temperature "
      "= 12 }, fx.lift_gamma_gain { gamma_offset = 0.1 }, fx.tone_mapping { mode = \"neutral\" }, fx.vignette { }",
      3e-5);
}

TEST_F(Effects, AUsersEffectMayAskForStraightColour) {
  write_test_file("shaders/bend/square.glsl",
                  "vec4 apply(vec4 color, vec4 other) { return vec4(color.rgb * color.rgb + 0.1, other.a * 0.3); }\n");
  const auto effect = [](const std::string& alpha) {
    write_test_file("effects/bend.lua",
                    "local fx = require \"afterglow\"\nreturn fx.effect { name = \"bend\", " + alpha +
                        " build = function(g, s, source) return g:pass { shader = \"bend/square\", source = source, "
                        "other = source } end }\n");
  };
  effect("alpha = \"straight\",");
  expect_straight("fx.bend { }");
  effect("");
  const Ramp ramp;
  EXPECT_GT(difference(run_stack("fx.bend { }", ramp.soft, Way::fused).result,
                       run_stack("fx.bend { }", ramp.opaque, Way::fused).result, ramp.soft),
            0.1);
}

TEST_F(Effects, LightWithoutCoverageIsGradedAsItIs) {
  Scene glow{"glow", DoubleImage(4, 1, Rgba(0.5, 2, 0.125, 0)), {}, {}};
  for (const Way way : {Way::plain, Way::fused})
    EXPECT_TRUE(agrees(run_stack("fx.tone_mapping { mode = \"reinhard\" }", glow, way).result,
                       tone_mapping(glow.source, ToneMode::reinhard), 1e-6, kRgb));
  EXPECT_NEAR(tone_mapping(glow.source, ToneMode::reinhard).pixels[0].g, 2.0 / 3, 1e-12);
}

/// Lifted blacks, tables that begin above 0: what an effect makes of light without coverage is that without what it
/// makes of black, so that empty parts of a layer stay empty and faint glows faint.
void expect_empty_stays_empty(const std::string& entries, double tolerance) {
  Scene empty{"empty", DoubleImage(24, 6, Rgba(0)), {}, {}};
  for (int x = 1; x < 24; ++x)
    for (int y = 0; y < 6; ++y) empty.source.at(x, y) = Rgba(1e-6 * std::exp2(x) * Rgb(1, 0.1 * y, 1 - 0.15 * y), 0);
  empty.source = in_floats(empty.source);
  Scene opaque = empty;
  for (auto& p : opaque.source.pixels) p.a = 1;
  for (const Way way : {Way::plain, Way::fused}) {
    const Made made = run_stack(entries, empty, way), on_black = run_stack(entries, opaque, way);
    ASSERT_TRUE(made.ran() && on_black.ran()) << entries;
    const auto of_black = from_floats(on_black.result.data(), {24, 6}, 4).at(0, 0);
    DoubleImage wanted = from_floats(on_black.result.data(), {24, 6}, 4);
    for (auto& p : wanted.pixels) p = Rgba(glm::max(Rgb(p) - Rgb(of_black), glm::min(Rgb(p), 0.0)), 0);
    EXPECT_EQ(Rgb(from_floats(made.result.data(), {24, 6}, 4).at(0, 0)), Rgb(0)) << entries;
    EXPECT_TRUE(agrees(made.result, wanted, tolerance, kRgba)) << entries;
  }
}

TEST_F(Effects, WhatIsEmptyStaysEmptyThroughEveryEffectThatBendsColour) {
  write_bent_cube();
  for (const auto& [effect, all] : bending())
    for (const auto& settings : all)
      if (effect != "film_grain")  // which differs from pixel to pixel
        expect_empty_stays_empty(fmt::format("fx.{} {{ {} }}", effect, settings), 1e-6);
  write_test_file("shaders/bend/square.glsl",
                  "vec4 apply(vec4 color) { return vec4(0.3 - color.rg * 0.1, color.b * color.b + 0.1, 0.3); }\n");
  write_test_file("effects/bend.lua",
                  "local fx = require \"afterglow\"\nreturn fx.effect { name = \"bend\", alpha = \"straight\", build = "
                  "function(g, s, source) return g:pass { shader = \"bend/square\", source = source } end }\n");
  expect_empty_stays_empty("fx.bend { }", 1e-6);
}

/// However passes are joined, each takes away what it makes of black.
TEST_F(Effects, EmptyPartsOfALayerDoNotDependOnHowPassesAreJoined) {
  write_bent_cube();
  const std::string entries =
      "fx.lift_gamma_gain { lift_offset = 0.1 }, fx.color_adjustments { contrast = -30 }, fx.cdl { offset = { 0.1, 0, "
      "0.05 }, opacity = 0.5 }, fx.lut { file = \"bent.cube\" }, fx.vignette {}";
  Scene scene = random_scene({33, 17}, 67);
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i)
    if (i % 3 == 0) scene.source.pixels[i] = i % 2 == 0 ? Rgba(0) : Rgba(Rgb(scene.source.pixels[i]), 0);
  const Made plain = run_stack(entries, scene, Way::plain), fused = run_stack(entries, scene, Way::fused);
  const DoubleImage one = from_floats(plain.result.data(), {33, 17}, 4);
  EXPECT_TRUE(agrees(fused.result, one, 1e-5, kRgba));
  for (std::size_t i = 0; i < one.pixels.size(); i += 6) EXPECT_EQ(one.pixels[i], Rgba(0)) << i;
}

/// Colours of a setting that are laid over a picture are as opaque as it is.
TEST_F(Effects, WhatIsLaidOverIsAsOpaqueAsThePicture) {
  Scene scene{"layer", DoubleImage(16, 12), DoubleImage(16, 12, Rgba(10, 0, 0, 1)), {}};
  Scene opaque = scene;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 16; ++x) {
      const double a = glm::clamp((x - 3) / 8.0, 0.0, 1.0);
      scene.source.at(x, y) = Rgba(0, 0, 0, a);
      opaque.source.at(x, y) = Rgba(0, 0, 0, 1);
      if (y > 5) scene.depth->at(x, y).r = 2;
    }
  opaque.depth = scene.depth;
  for (const std::string entries :
       {"fx.letterbox { aspect = 4, color = { 1, 0.5, 2 } }",
        "fx.edge_detection { background_opacity = 0.75, background = { 1, 0.5, 0.2 }, threshold = 1 }",
        "fx.outline { source = \"depth\", color = { 1, 0.5, 0.2 } }",
        "fx.outline { source = \"depth\", color = { 1, 0.5, 0.2 }, blend = \"add\" }"}) {
    const Made layer = run_stack(entries, scene, Way::fused), whole = run_stack(entries, opaque, Way::fused);
    double lit = 0;
    for (std::size_t i = 0; i < scene.source.pixels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        lit += whole.result[4 * i + c];
        EXPECT_NEAR(layer.result[4 * i + c], whole.result[4 * i + c] * scene.source.pixels[i].a, 1e-6) << entries << i;
      }
    EXPECT_GT(lit, 5) << entries;
    EXPECT_TRUE(alpha_is_kept(layer, scene)) << entries;
  }
}

/// A disc with a soft edge that glows: where its alpha ends a tone curve leaves a ring, but not where it takes colours
/// as they are.
TEST_F(Effects, AssociatedColoursLeaveNoRingAroundWhatGlows) {
  const std::string entries = "fx.cdl { slope = { 2, 2, 2 } }, fx.tone_mapping { mode = \"reinhard\" }";
  Scene scene{"glow", DoubleImage(33, 1), {}, {}};
  for (int x = 0; x < 33; ++x) {
    const double a = glm::clamp((20.0 - x) / 8, 0.0, 1.0);
    scene.source.at(x, 0) = Rgba(Rgb(1.5 * a + 0.6 * std::exp(-std::abs(x - 16) / 20.0)), a);
  }
  scene.source = in_floats(scene.source);
  Scene opaque = scene;
  for (auto& p : opaque.source.pixels) p.a = 1;
  for (const Way way : {Way::plain, Way::fused}) {
    const auto as_it_is = run_stack("alpha = \"associated\", " + entries, scene, way);
    const auto on_black = run_stack(entries, opaque, way), straight = run_stack(entries, scene, way);
    EXPECT_TRUE(alpha_is_kept(as_it_is, scene));
    EXPECT_TRUE(agrees(as_it_is.result, from_floats(on_black.result.data(), {33, 1}, 4), 0, kRgb));
    EXPECT_LT(straight.result[4 * 19], 0.5 * straight.result[4 * 21]) << "the ring";
    EXPECT_GT(as_it_is.result[4 * 19], as_it_is.result[4 * 21]);
  }
}

TEST_F(Effects, StraightColourStaysFiniteWhereAlphaIsTiny) {
  Scene scene{"tiny", DoubleImage(3, 1, Rgba(1e30, 1, 0, 1e-30)), {}, {}};
  scene.source = in_floats(scene.source);
  const Made made = run_stack("fx.tone_mapping { mode = \"reinhard\" }", scene, Way::fused);
  EXPECT_TRUE(all_finite(made.result));
}

/// Below the smallest normal float, which is 0 for devices and threads that flush such numbers.
TEST_F(Effects, WhatIsTooLittleToBeAnAlphaCountsAsNone) {
  Scene little{"little", DoubleImage(3, 1, Rgba(0.5, 2, 0.125, 1e-39)), {}, {}}, none = little;
  little.source.at(1, 0).a = 1.4e-45;
  little.source = in_floats(little.source);
  for (auto& p : none.source.pixels) p.a = 0;
  for (const std::string entries :
       {"fx.tone_mapping { mode = \"reinhard\" }", "fx.cdl { power = { 1.2, 1, 0.8 }, blend = \"screen\" }"})
    for (const Way way : {Way::plain, Way::fused})
      EXPECT_TRUE(agrees(run_stack(entries, little, way).result,
                         from_floats(run_stack(entries, none, way).result.data(), {3, 1}, 4), 0, kRgb))
          << entries;
}

TEST_F(Effects, StraightColourStaysFiniteWhereAlphaIsOutOfAllBounds) {
  Scene scene{"huge", DoubleImage(3, 1, Rgba(1e30, 2, 0, 1e20)), {}, {}};
  scene.source.at(1, 0) = Rgba(1e30, 65504, 1, 65504);
  scene.source = in_floats(scene.source);
  for (const std::string entries : {"fx.cdl { power = { 10, 0.1, 1 } }", "fx.split_toning { shadows = { 0, 0, 0 } }",
                                    "fx.cdl { slope = { 16, 2, 1 } }, fx.lift_gamma_gain { gamma = { 0.6, 0.6, 0 } }"})
    for (const Way way : {Way::plain, Way::fused})
      EXPECT_TRUE(all_finite(run_stack(entries, scene, way).result)) << entries;
  // An alpha that pictures may have loses nothing of its meaning.
  EXPECT_TRUE(agrees(
      run_stack("fx.cdl { slope = { 2, 2, 2 } }", scene, Way::fused).result,
      [&] {
        auto doubled = scene.source;
        for (auto& p : doubled.pixels) p = Rgba(glm::min(2 * p.r / cover(p), 1e30) * cover(p), 2 * p.g, 2 * p.b, p.a);
        return doubled;
      }(),
      1e-6, kRgb));
}

/// As users run it: whole pictures, of which it is known whether they are opaque.
TEST_F(Effects, OpaquePicturesDivideNothingAndKeepTheirBytes) {
  const auto file = write_test_file("opaque.lua",
                                    "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { "
                                    "contrast = 20 }, fx.tone_mapping { } }\n");
  Diagnostics diagnostics;
  const auto run = [&](Image image, bool skip) {
    SessionOptions options;
    options.device.validate = true;
    options.stack.skip_idle = skip;
    auto session = Session::open(file, options, diagnostics);
    EXPECT_TRUE(session) << session.error().text();
    Picture picture;
    picture.color = std::move(image);
    EXPECT_TRUE((*session)->process(picture));
    return std::pair{picture.color.pixels, (*session)->report()};
  };
  Image opaque(64, 24, 4);
  for (std::size_t i = 0; i < opaque.pixels.size(); ++i)
    opaque.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i % 97) * 0.05f;
  const auto [skipped, report] = run(opaque, true);
  const auto [whole, whole_report] = run(opaque, false);
  EXPECT_EQ(skipped, whole);
  ASSERT_EQ(report.skipped_now.size(), 1u);
  EXPECT_EQ(report.skipped_now[0].name, "division by alpha in 2 passes");
  EXPECT_EQ(report.skipped_now[0].reason, "alpha is 1 everywhere");
  EXPECT_EQ(report.counters.programs, 1);  // what most pictures need is made first
  EXPECT_TRUE(whole_report.skipped_now.empty());

  Image soft = opaque;
  soft.pixels[4 * 500 + 3] = 0.5f;
  const auto [softened, soft_report] = run(soft, true);
  EXPECT_TRUE(soft_report.skipped_now.empty());
  EXPECT_EQ(soft_report.counters.programs, 2);
  EXPECT_EQ(softened, run(soft, false).first);
  EXPECT_NE(softened[4 * 500], whole[4 * 500]);
}

}  // namespace
}  // namespace afterglow
