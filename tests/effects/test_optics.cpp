// SPDX-License-Identifier: MIT
// Light that spreads in lenses, film and air, and what shows pictures: halation, glare, lens flares, fog, bars, tubes.
#include <fmt/format.h>

#include <cmath>

#include "cases.h"
#include "files.h"
#include "reference/air.h"
#include "reference/cut.h"
#include "reference/glow.h"
#include "reference/occlusion.h"
#include "reference/screen.h"

namespace afterglow {
namespace {

using namespace reference;

std::string rgb(const Rgb& c) { return fmt::format("{{ {}, {}, {} }}", c.r, c.g, c.b); }

EffectCase halated(const Halation& v) {
  return {
      fmt::format(
          "fx.halation {{ intensity = {}, radius = {}, threshold = {}, clamp = {}, color = {}, source_color = {} }}",
          v.intensity, v.radius, v.threshold, v.clamp, rgb(v.color), v.source_color),
      [=](const Scene& s) { return halation(s.source, v); }};
}

EffectCase glared(const Glare& v, const char* kind) {
  return {fmt::format("fx.glare {{ kind = \"{}\", intensity = {}, threshold = {}, clamp = {}, points = {}, angle = {}, "
                      "size = {}, dispersion = {}, tint = {} }}",
                      kind, v.intensity, v.threshold, v.clamp, v.points, v.angle, v.size, v.dispersion, rgb(v.tint)),
          [=](const Scene& s) { return glare(s.source, v); }};
}

EffectCase flared(const LensFlare& v) {
  return {
      fmt::format("fx.lens_flare {{ ghosts = {}, halo = {}, starburst = {}, threshold = {}, clamp = {}, count = {}, "
                  "spacing = {}, blades = {}, rotation = {}, iris = {}, halo_radius = {}, ray_length = {}, "
                  "dispersion = {}, tint = {} }}",
                  v.ghosts, v.halo, v.starburst, v.threshold, v.clamp, v.count, v.spacing, v.blades, v.rotation, v.iris,
                  v.halo_radius, v.ray_length, v.dispersion, rgb(v.tint)),
      [=](const Scene& s) { return lens_flare(s.source, v); }};
}

EffectCase fogged(const DepthFog& v) {
  return {fmt::format("fx.depth_fog {{ density = {}, start = {}, color = {}, ambient = {}, max_opacity = {}, sky = {}, "
                      "scattering = {}, scattering_radius = {}, height_falloff = {}, camera_height = {}, "
                      "camera_pitch = {}, field_of_view = {}, sun_color = {}, sun = {{ {}, {} }}, sun_focus = {} }}",
                      v.density, v.start, rgb(v.color), v.ambient, v.max_opacity, v.sky, v.scattering,
                      v.scattering_radius, v.height_falloff, v.camera_height, v.camera_pitch, v.field_of_view,
                      rgb(v.sun_color), v.sun_x, v.sun_y, v.sun_focus),
          [=](const Scene& s) { return depth_fog(s.source, *s.depth, v); }};
}

EffectCase barred(const Letterbox& v) {
  return {fmt::format("fx.letterbox {{ aspect = {}, color = {}, offset = {} }}", v.aspect, rgb(v.color), v.offset),
          [=](const Scene& s) { return letterbox(s.source, v); }};
}

EffectCase tubed(const Crt& v) {
  return {
      fmt::format(
          "fx.crt {{ lines = {}, softness = {}, scan_lines = {}, phosphor = {}, phosphor_size = {}, "
          "curvature = {}, corner = {}, vignette = {}, glow = {}, convergence = {}, brightness = {}, intensity = {} }}",
          v.lines, v.softness, v.scan_lines, v.phosphor, v.phosphor_size, v.curvature, v.corner, v.vignette, v.glow,
          v.convergence, v.brightness, v.intensity),
      [=](const Scene& s) { return crt(s.source, v); }};
}

double sum_of(const DoubleImage& image, int channel) {
  double sum = 0;
  for (const auto& p : image.pixels) sum += p[channel];
  return sum;
}

/// Black with one light in the middle.
Scene lamp(Size size, double light) {
  Scene scene{"lamp", DoubleImage(size), DoubleImage(size, Rgba(5, 0, 0, 1)), {}};
  scene.source.at(size.width / 2, size.height / 2) = Rgba(light, light, light, 1);
  return scene;
}

/// A round lamp of radius 1.5, as a camera sees it: pixels by the share that it covers.
Scene small_lamp(Size size, double middle, double light) {
  Scene scene{"small lamp", DoubleImage(size, Rgba(0, 0, 0, 1)), {}, {}};
  constexpr int kParts = 8;
  for (int y = 0; y < size.height * kParts; ++y)
    for (int x = 0; x < size.width * kParts; ++x)
      if (std::hypot((x + 0.5) / kParts - middle, (y + 0.5) / kParts - middle) < 1.5)
        scene.source.at(x / kParts, y / kParts) += Rgba(Rgb(light / (kParts * kParts)), 0);
  return scene;
}

TEST_F(Effects, LampsThatMoveDoNotBlink) {
  // Some light of the picture's own threshold moves between pixels; what is left is that of the lamp's own rim.
  for (const char* entries :
       {"fx.halation { threshold = 1.5, clamp = 12 }", "fx.glare { threshold = 12 }",
        "fx.glare { kind = 'fog_glow', threshold = 12 }", "fx.anamorphic_streaks { threshold = 8 }"}) {
    double least = 1e30, most = 0;
    for (int i = 0; i < 8; ++i) {
      const Scene scene = small_lamp({64, 64}, 31 + 0.25 * i, 20);
      const auto made = run_stack(entries, scene, Way::plain).result;
      double added = 0;
      for (std::size_t p = 0; p < made.size(); p += 4) added += made[p];
      added -= sum_of(scene.source, 0);
      least = std::min(least, added), most = std::max(most, added);
    }
    EXPECT_GT(least, 0.5 * most) << entries;
  }
}

TEST_F(Effects, RaysAreAsWideAndAsBrightAtEveryHeight) {
  for (const int lines : {1080, 1440, 1442, 2160}) {
    const Made made = run_stack("fx.glare { threshold = 0.5 }", random_scene({16, lines}, 9), Way::plain);
    EXPECT_EQ(made.size_of("glare.ray[0][0]").height, 540) << lines;
  }
}

TEST_F(Effects, HalationAgrees) {
  agree_everywhere({halated({.threshold = 0.3}),
                    halated({.intensity = 2, .radius = 60, .threshold = 0, .clamp = 5, .color = {0.2, 1, 3}}),
                    halated({.radius = 0.5, .threshold = 0.5, .source_color = 0.3})});
  expect_skipped("fx.halation { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.halation { threshold = 9, clamp = 2 }", "clamp is not above threshold");
  expect_skipped("fx.halation { color = { 0, 0, 0 } }", "color is black");
}

TEST_F(Effects, HalationPassByPass) {
  for (const Size size : kSizes) {
    const auto scene = random_scene(size, 71);
    const Made made = run_stack("fx.halation { radius = 5, threshold = 0.5 }", scene, Way::plain);
    SCOPED_TRACE(scene.name);
    const auto light = glow_half(through_film(glow_bright(scene.source, 0.5, 20), 0));
    const auto weights = exponential_weights(size, 5.0 * Rgb(1, 0.6, 0.4));
    EXPECT_TRUE(agrees(made.pixels("halation.bright"), light, kFullFloat, kRgb));
    EXPECT_TRUE(agrees(made.pixels("halation.glow"), glow_of(light, size, weights), kFullFloat, kRgb));
  }
}

TEST_F(Effects, HalationIsRedAndKeepsItsShare) {
  const auto scene = lamp({256, 256}, 16);
  const Made made = run_stack("fx.halation { radius = 10, threshold = 0, intensity = 0.5 }", scene, Way::plain);
  const auto result = from_floats(made.result.data(), made.size, 4);
  const double added = sum_of(result, 0) - 16;
  EXPECT_NEAR(added, 0.5 * 16, 0.02 * 16);  // a share of the light, none at the edges
  EXPECT_GT(result.at(128, 100).r, 20 * result.at(128, 100).b);
}

TEST_F(Effects, HalationIsRedWhateverGlows) {
  const auto added = [&](const Rgb& light, const char* more) {
    auto scene = lamp({128, 128}, 1);
    for (auto& p : scene.source.pixels) p = Rgba(Rgb(p) * light * 4.0, 1);
    const Made made = run_stack(fmt::format("fx.halation {{ radius = 8, threshold = 0{} }}", more), scene, Way::plain);
    const auto result = from_floats(made.result.data(), made.size, 4);
    return Rgb(sum_of(result, 0) - sum_of(scene.source, 0), sum_of(result, 1) - sum_of(scene.source, 1),
               sum_of(result, 2) - sum_of(scene.source, 2));
  };
  for (const Rgb& light : {Rgb(0.05, 0.8, 1), Rgb(0.05, 1, 0.1), Rgb(0.1, 0.1, 1), Rgb(1, 0.2, 0.6), Rgb(1, 1, 1)}) {
    const Rgb glow = added(light, "");
    EXPECT_GT(glow.r, 0.01 * 4);
    EXPECT_LT(glow.g, 0.4 * glow.r) << light.r << ' ' << light.g << ' ' << light.b;
    EXPECT_LT(glow.b, 0.25 * glow.r);
  }
  // As much as ever of light that has red.
  for (const Rgb& light : {Rgb(1, 1, 1), Rgb(1, 0.2, 0.6)})
    EXPECT_NEAR(added(light, "").r, added(light, ", source_color = 1").r, 1e-4);
  EXPECT_GT(added({0.05, 0.8, 1}, ", source_color = 1").g, added({0.05, 0.8, 1}, ", source_color = 1").r);
}

TEST_F(Effects, GlareAgrees) {
  agree_everywhere(
      {glared({.threshold = 1}, "star"),
       glared({.threshold = 0.5, .points = 5, .angle = 90, .size = 1, .dispersion = 1, .tint = {2, 1, 0}}, "star"),
       glared({.kind = GlareKind::streaks, .threshold = 1, .angle = 0, .dispersion = 0}, "streaks")},
      kBetweenPixels);
  agree_everywhere({glared({.kind = GlareKind::fog_glow, .threshold = 0.5}, "fog_glow"),
                    glared({.kind = GlareKind::fog_glow, .intensity = 3, .threshold = 0, .size = 2}, "fog_glow")});
  expect_skipped("fx.glare { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.glare { clamp = 1 }", "clamp is not above threshold");
  expect_skipped("fx.glare { tint = { 0, 0, 0 } }", "tint is black");
}

TEST_F(Effects, GlareOfEveryKindIsAShareOfTheLight) {
  const auto scene = lamp({400, 400}, 400);
  for (const char* kind : {"star", "streaks", "fog_glow"}) {
    const Made made = run_stack(fmt::format("fx.glare {{ kind = \"{}\", threshold = 0, clamp = 1000, intensity = 0.5, "
                                            "size = 0.2, dispersion = 0 }}",
                                            kind),
                                scene, Way::plain);
    const auto result = from_floats(made.result.data(), made.size, 4);
    EXPECT_NEAR(sum_of(result, 1) - 400, 200, 10) << kind;
  }
}

TEST_F(Effects, StarsHaveTheirPoints) {
  const auto scene = lamp({300, 300}, 5000);
  const Made made = run_stack("fx.glare { points = 4, angle = 0, size = 0.4, clamp = 5000 }", scene, Way::plain);
  const auto result = from_floats(made.result.data(), made.size, 4);
  for (const int way : {-30, 30}) {
    EXPECT_GT(result.at(150 + way, 150).g, 20 * result.at(150 + way, 150 + way).g);
    EXPECT_GT(result.at(150, 150 + way).g, 20 * result.at(150 + way, 150 + way).g);
  }
}

TEST_F(Effects, LensFlareAgrees) {
  agree_everywhere({flared({.threshold = 1}),
                    flared({.ghosts = 1, .halo = 0, .starburst = 0, .threshold = 0.5, .count = 8, .blades = 5}),
                    flared({.ghosts = 0, .halo = 0, .starburst = 1, .threshold = 0.5, .blades = 5}),
                    flared({.ghosts = 0.1, .halo = 2, .starburst = 0, .threshold = 1, .clamp = 20, .iris = 0.1})},
                   {.full = 2e-3, .fused = 5e-4, .half = 1, .spikes = false});
  expect_skipped("fx.lens_flare { ghosts = 0, halo = 0, starburst = 0 }", "ghosts, halo and starburst are 0");
  expect_skipped("fx.lens_flare { tint = { 0, 0, 0 } }", "tint is black");
}

TEST_F(Effects, GhostsAreMirroredAtTheMiddle) {
  Scene scene{"lamp", DoubleImage(480, 270), {}, {}};
  for (int y = 80; y < 88; ++y)
    for (int x = 140; x < 148; ++x) scene.source.at(x, y) = Rgba(100, 100, 100, 1);
  const Made made =
      run_stack("fx.lens_flare { count = 2, halo = 0, starburst = 0, dispersion = 0 }", scene, Way::plain);
  const auto result = from_floats(made.result.data(), made.size, 4);
  // The second ghost is as large as the light's image, on the other side of (240, 135).
  EXPECT_GT(result.at(336, 187).r, 0.05);
  EXPECT_LT(result.at(336, 83).r, 1e-3);
  EXPECT_LT(result.at(60, 187).r, 1e-3);
}

TEST_F(Effects, DepthFogAgrees) {
  agree_everywhere({fogged({}), fogged({.density = 0.2, .start = 0, .ambient = 0, .max_opacity = 1, .scattering = 0}),
                    fogged({.density = 0.05,
                            .sky = 1,
                            .height_falloff = 0.3,
                            .camera_height = 3,
                            .camera_pitch = -10,
                            .field_of_view = 70,
                            .sun_color = {3, 2, 1},
                            .sun_x = 0.8,
                            .sun_y = -0.2})},
                   {.full = 2e-4, .fused = 2e-5, .half = kHalfFloat, .spikes = false});
  expect_skipped("fx.depth_fog { density = 0 }", "density is 0");
  expect_skipped("fx.depth_fog { max_opacity = 0 }", "max_opacity is 0");
}

TEST_F(Effects, FogOfHalfCoveredPixelsIsThatOfTheirLikes) {
  // A wire that covers half of two rows: depth says wire and sky in turns.
  Scene scene{"wire", DoubleImage(64, 64, Rgba(0.2, 0.2, 0.2, 1)), DoubleImage(64, 64, Rgba(1e10, 0, 0, 1)), {}};
  for (int x = 0; x < 64; ++x) {
    for (int y : {31, 32}) scene.source.at(x, y) = Rgba(0.1, 0.1, 0.1, 1);
    scene.depth->at(x, 31 + x % 2) = Rgba(20, 0, 0, 1);
  }
  const Made made = run_stack(
      "fx.depth_fog { density = 0.05, scattering = 0, ambient = 0, sky = 0, color = { 1, 1, 1 } }", scene, Way::plain);
  const auto at = [&](int x, int y) { return made.result[4 * static_cast<std::size_t>(y * 64 + x)]; };
  EXPECT_NEAR(at(32, 31), at(33, 31), 1e-3);  // 0.45 apart by their own depths
  EXPECT_NEAR(at(32, 20), 0.2, 1e-6);
}

TEST_F(Effects, FogFollowsBeerAndLambert) {
  Scene scene{"wall", DoubleImage(65, 65), DoubleImage(65, 65, Rgba(10, 0, 0, 1)), {}};
  const Made made = run_stack(
      "fx.depth_fog { density = 0.1, start = 0, max_opacity = 1, scattering = 0, ambient = 0, color = { 1, 1, 1 } }",
      scene, Way::plain);
  EXPECT_NEAR(made.result[4 * (32 * 65 + 32)], 1 - std::exp(-1.0), 1e-5);  // the middle's ray is 10 m long
  EXPECT_GT(made.result[0], made.result[4 * (32 * 65 + 32)]);              // the corner's is longer
}

TEST_F(Effects, LetterboxAgrees) {
  agree_everywhere({barred({.aspect = 2.39}), barred({.aspect = 3.1, .color = {0.2, 0.4, 2}}),
                    barred({.aspect = 20, .offset = -0.3}), barred({.aspect = 0.3, .offset = 1}),
                    barred({.aspect = 0.3126, .color = {0.24, 1e4, 0.07}, .offset = -0.23858124}),
                    barred({.aspect = 0.499999, .color = {0.24, 1e5, 0.07}})});  // a bar over a millionth of a pixel
  Scene square{"square", DoubleImage(64, 64, Rgba(0.5, 0.5, 0.5, 1)), {}, {}};
  EXPECT_FALSE(run_stack("fx.letterbox { aspect = 1 }", square, Way::plain).ran());
  EXPECT_FALSE(run_stack("fx.letterbox { aspect = 0.9925 }", square, Way::plain).ran());  // 0.48 pixels
  double before = 0;
  for (double bars = 0; bars < 2.5; bars += 0.1) {  // of an animated shape: pixels across that they cover
    const auto shape = fmt::format("fx.letterbox {{ aspect = {}, offset = 0.3 }}", (64 - bars) / 64);
    double hidden = 0;
    const auto made = run_stack(shape, square, Way::plain).result;
    for (std::size_t i = 0; i < made.size(); i += 4) hidden += (0.5 - made[i]) / 0.5 / 64;
    EXPECT_NEAR(hidden, before + 0.1, 0.11) << bars;
    before = hidden;
  }
  expect_skipped("fx.letterbox { aspect = 0 }", "aspect is 0");
}

TEST_F(Effects, CrtAgrees) {
  agree_everywhere({tubed({}), tubed({.lines = 16, .softness = 1.5, .glow = 0.5, .convergence = 2}),
                    tubed({.lines = 20, .phosphor = 1, .phosphor_size = 4.3, .curvature = 1, .corner = 0.3}),
                    tubed({.lines = 40, .scan_lines = 0, .phosphor = 0, .glow = 0, .brightness = 2, .intensity = 0.3})},
                   {.full = 3e-3, .fused = 1e-4, .half = 1, .spikes = false});
  expect_skipped("fx.crt { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, CrtHasNoMoireOnSmallPictures) {
  // White at 480 lines of a look made for 1080: its stripes are 1.33 pixels wide, its lines 1.78 pixels apart.
  const Scene scene{"white", DoubleImage(256, 480, Rgba(0.5, 0.5, 0.5, 1)), {}, {}};
  const auto made = run_stack(
                        "fx.crt { phosphor_size = 1.3333, phosphor = 1, scan_lines = 1, curvature = 0, corner = 0, "
                        "vignette = 0, glow = 0 }",
                        scene, Way::plain)
                        .result;
  float least = 1, most = 0;
  for (int y = 40; y < 440; ++y)
    for (int x = 40; x < 216; ++x) {
      const float v = made[4 * static_cast<std::size_t>(256 * y + x)];
      least = std::min(least, v), most = std::max(most, v);
    }
  EXPECT_LT(most - least, 0.01F);
}

TEST_F(Effects, CrtKeepsTheMeanLight) {
  const Scene grey{"grey", DoubleImage(240, 240, Rgba(0.25, 0.25, 0.25, 1)), {}, {}};
  const Made made =
      run_stack("fx.crt { lines = 60, curvature = 0, corner = 0, vignette = 0, brightness = 1 }", grey, Way::plain);
  const auto result = from_floats(made.result.data(), made.size, 4);
  double sum = 0;
  for (int y = 60; y < 180; ++y)
    for (int x = 60; x < 180; ++x) sum += result.at(x, y).g;
  EXPECT_NEAR(sum / (120 * 120), 0.25, 0.01);
}

EffectCase shaded(const Ssao& v, const char* normals) {
  return {fmt::format("fx.ssao {{ intensity = {}, radius = {}, max_radius = {}, samples = {}, bias = {}, spare = {}, "
                      "color = {}, field_of_view = {}, normals = \"{}\", camera_forward = {}, camera_up = {} }}",
                      v.intensity, v.radius, v.max_radius, v.samples, v.bias, v.spare, rgb(v.color), v.field_of_view,
                      normals, rgb(v.camera_forward), rgb(v.camera_up)),
          [=](const Scene& s) { return ssao(s.source, *s.depth, s.normal ? &*s.normal : nullptr, v); }};
}

TEST_F(Effects, SsaoAgrees) {
  agree_everywhere(
      {shaded({}, "from_depth"),
       shaded({.intensity = 3, .radius = 5, .max_radius = 0.5, .samples = 40, .color = {0.3, 0.1, 0}}, "from_depth"),
       shaded({.radius = 2, .normals = SurfaceNormals::view}, "view"),
       shaded({.spare = 1e6,
               .field_of_view = 70,
               .normals = SurfaceNormals::world,
               .camera_forward = {0.3, 0.8, -0.2},
               .camera_up = {0.1, 0, 1}},
              "world")},
      kDecisions);
  expect_skipped("fx.ssao { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.ssao { color = { 1, 1, 1 } }", "color is white");
}

/// Squares of such ways are 0 or not, as a thread takes numbers below the normal ones.
TEST_F(Effects, SsaoFindsNoSurfaceWhereThereAreNoDigits) {
  auto scene = random_scene({17, 5}, 61);
  for (std::size_t i = 0; i < scene.depth->pixels.size(); ++i) scene.depth->pixels[i].r = i % 3 == 0 ? 1e-39 : 3e-20;
  scene.depth = in_floats(*scene.depth);
  for (const Way way : {Way::plain, Way::fused})
    EXPECT_TRUE(agrees(run_stack("fx.ssao { spare = 1e6 }", scene, way).result, scene.source, 0, kRgba));
}

TEST_F(Effects, SsaoShadesCornersAndLeavesPlanes) {
  // A floor that meets a wall 8 m away, seen from 2 m above it.
  const Size size{160, 120};
  Scene scene{"corner", DoubleImage(size, Rgba(0.5, 0.5, 0.5, 1)), DoubleImage(size), {}};
  const double tan = std::tan(20 * 3.14159265358979 / 180);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double down = (2 * (y + 0.5) / size.height - 1) * tan;
      scene.depth->at(x, y).r = std::min(8.0, down > 0 ? 2 / down : 8.0);
    }
  scene.depth = in_floats(*scene.depth);
  const Made made = run_stack("fx.ssao { radius = 1 }", scene, Way::plain);
  const auto at = [&](int y) { return made.result[4 * static_cast<std::size_t>(y * size.width + 80)]; };
  const int corner = static_cast<int>((2 / 8.0 / tan + 1) / 2 * size.height);
  EXPECT_LT(at(corner), 0.42F);
  EXPECT_GT(at(20), 0.495F);              // the wall
  EXPECT_GT(at(size.height - 4), 0.49F);  // the floor at the camera's feet
}

EffectCase cut(const Cut& v, const char* kind) {
  return {fmt::format(
              "fx.transition {{ kind = \"{}\", progress = {}, color = {}, angle = {}, softness = {}, center = {{ "
              "{}, {} }}, count = {}, grain = {}, seed = {} }}",
              kind, v.progress, rgb(v.color), v.angle, v.softness, v.center_x, v.center_y, v.count, v.grain, v.seed),
          [=](const Scene& s) { return transition(s.source, nullptr, v); }};
}

TEST_F(Effects, TransitionAgrees) {
  const Rgb red{2, 0.1, 0};
  const double p = 0.43;
  agree_everywhere(
      {cut({p, CutKind::dissolve, red}, "dissolve"), cut({p, CutKind::fade, red}, "fade"),
       cut({0.8, CutKind::fade, red}, "fade"), cut({p, CutKind::wipe, red, 33, 0.3}, "wipe"),
       cut({p, CutKind::iris, red, 0, 0.2, 0.3, 0.9}, "iris"), cut({p, CutKind::clock, red, 100, 0.4}, "clock"),
       cut({p, CutKind::blinds, red, 250, 0.8, 0.5, 0.5, 3}, "blinds"),
       cut({p, CutKind::scatter, red, 0, 0.4, 0.5, 0.5, 1, 3.5, 9}, "scatter"),
       cut({p, CutKind::push, red, 70}, "push"), cut({p, CutKind::push, red, 200}, "push")},
      {.full = 5e-4, .fused = 1e-5, .half = 5e-3});
  expect_skipped("fx.transition {}", "progress is 0");
}

TEST_F(Effects, TransitionsWithoutSoftnessHaveSmoothEdges) {
  const Rgb red{2, 0.1, 0};
  agree_everywhere(
      {cut({0.43, CutKind::wipe, red, 33, 0}, "wipe"), cut({0.43, CutKind::iris, red, 0, 0, 0.3, 0.9}, "iris"),
       cut({0.43, CutKind::clock, red, 100, 0}, "clock"),
       cut({0.43, CutKind::blinds, red, 250, 0, 0.5, 0.5, 3}, "blinds")},
      {.full = 5e-4, .fused = 1e-5, .half = 5e-3});
  // A line of black and white, through the edges and seams of each: as much white as its area, wherever the line lies.
  Scene white{"white", DoubleImage(41, 33, Rgba(1)), {}, {}};
  for (const auto& [look, shown] : {std::pair{"kind = 'wipe', angle = 0", 0.5},
                                    {"kind = 'wipe', angle = 90", 0.5},
                                    {"kind = 'clock', angle = 90", 0.5},
                                    {"kind = 'blinds', count = 3, angle = 0", 0.5},
                                    {"kind = 'blinds', count = 2, angle = 33", 0.5}}) {
    const Made made =
        run_stack(fmt::format("fx.transition {{ softness = 0, progress = 0.5, {} }}", look), white, Way::plain);
    double sum = 0;
    for (std::size_t i = 0; i < made.result.size(); i += 4) sum += made.result[i];
    EXPECT_NEAR(sum / (41 * 33), shown, 0.01) << look;
  }
}

TEST_F(Effects, TransitionsEndAtTheOtherPicture) {
  Scene scene = random_scene({64, 36}, 73);
  scene.layers["next"] = random_scene({64, 36}, 74).source;
  for (const char* kind : {"dissolve", "fade", "wipe", "iris", "clock", "blinds", "scatter", "push"}) {
    const Made made = run_stack(fmt::format("fx.transition {{ kind = \"{}\", layer = \"next\", progress = 1 }}", kind),
                                scene, Way::plain);
    EXPECT_TRUE(agrees(made.result, scene.layers["next"], 1e-6, kRgb)) << kind;
  }
}

TEST_F(Effects, TransitionsGoOverToTheFrameThatIsNamed) {
  // Pictures of one colour, 2^(e - 128) / 2 of red: the other side is a sequence when `to` depends on the frame.
  for (const auto& [frame, exponent] : {std::pair{7, 129}, std::pair{8, 131}})
    write_test_file(fmt::format("next.{:04}.hdr", frame), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                                              std::string{'\x80', '\x00', '\x00', char(exponent)});
  Scene scene = random_scene({20, 12}, 75);
  for (const auto& [frame, red] : {std::pair{2, 1.0}, std::pair{3, 4.0}}) {
    scene.frame = frame;
    const Made made = run_stack(
        "fx.transition { progress = 1, to = function(t) return string.format('next.%04d.hdr', t.frame + 5) end }",
        scene, Way::plain);
    EXPECT_TRUE(agrees(made.result, DoubleImage(20, 12, Rgba(red, 0, 0, 1)), 0.02, kRgb)) << frame;
  }
}

EffectCase stepped(const Posterize& v) {
  return {fmt::format("fx.posterize {{ levels = {}, softness = {}, intensity = {}, shadows = {} }}", v.levels,
                      v.softness, v.intensity, v.shadows),
          [=](const Scene& s) { return posterize(s.source, v); }};
}

TEST_F(Effects, PosterizeAgrees) {
  agree_everywhere({stepped({}), stepped({.levels = 2, .softness = 1}), stepped({.levels = 12, .intensity = 0.4}),
                    stepped({.shadows = 0.7}), stepped({.levels = 2, .shadows = 1})},
                   {.full = 1e-3, .fused = 1e-4, .half = 2e-2});
  expect_skipped("fx.posterize { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, PosterizeMayKeepDarkColours) {
  // Dark wood: half of it went black, the other half red.
  Scene wood{"wood", DoubleImage(64, 1), {}, {}};
  for (int x = 0; x < 64; ++x) wood.source.at(x, 0) = Rgba(Rgb(4, 1, 0.5) * (0.004 + 0.0004 * x), 1);
  const auto range = [&](const char* more) {
    const Made made = run_stack(fmt::format("fx.posterize {{ levels = 5{} }}", more), wood, Way::plain);
    double least = 1, most = 0;
    for (std::size_t x = 0; x < 64; ++x) {
      const float* p = &made.result[4 * x];
      EXPECT_NEAR(p[0], 4 * p[1], 1e-4);  // its hue stays
      least = std::min<double>(least, p[0]), most = std::max<double>(most, p[0]);
    }
    return std::pair(least, most);
  };
  EXPECT_EQ(range("").first, 0);
  const auto [least, most] = range(", shadows = 1");
  EXPECT_NEAR(least, 4 * 0.004, 1e-4);
  EXPECT_EQ(most, range("").second);
}

TEST_F(Effects, PosterizeLeavesFewTones) {
  Scene ramp{"ramp", DoubleImage(1000, 1), {}, {}};
  for (int x = 0; x < 1000; ++x) ramp.source.at(x, 0) = Rgba(Rgb(x / 999.0 * x / 999.0), 1);
  const Made made = run_stack("fx.posterize { levels = 5, softness = 0 }", ramp, Way::plain);
  for (int x = 0; x < 1000; ++x) {
    const double tone = std::sqrt(made.result[4 * static_cast<std::size_t>(x)]) * 4;
    EXPECT_NEAR(tone, std::round(tone), 2e-2) << x;
  }
}

}  // namespace
}  // namespace afterglow
