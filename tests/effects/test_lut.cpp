// SPDX-License-Identifier: MIT
// Look-up tables: against OpenColorIO's own evaluation, tetrahedral on the CPU.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "files.h"
#include "harness.h"
#include "reference/color.h"

namespace OCIO = OCIO_NAMESPACE;

namespace afterglow {
namespace {

using namespace reference;

std::mt19937 generator(71);

double random_value(double low, double high) { return std::uniform_real_distribution(low, high)(generator); }

std::string random_rows(int count, double low = -0.2, double high = 1.3) {
  std::string out;
  for (int i = 0; i < count; ++i)
    out += fmt::format("{:.6f} {:.6f} {:.6f}\n", random_value(low, high), random_value(low, high),
                       random_value(low, high));
  return out;
}

/// Colours in and out of the domain, on the entries of tables, on their diagonals and just beside.
Scene colours() {
  Scene scene{"colours", DoubleImage(64, 64), {}, {}};
  static constexpr double kCorners[] = {0, 1, 0.5, 1.0 / 3, 0.25, 1e-7, 1 - 1e-7, -0.5, 1.5, 1e4, 1e30};
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i) {
    auto& p = scene.source.pixels[i];
    const auto any = [&] { return kCorners[generator() % std::size(kCorners)]; };
    if (i % 4 == 0)
      p = {any(), any(), any(), 1};
    else if (i % 4 == 1)
      p = Rgba(Rgb(random_value(0, 1)), 0.5);  // grey: the diagonal that all tetrahedra share
    else if (i % 4 == 2)
      p = {random_value(-0.5, 2), random_value(-0.5, 2), random_value(-0.5, 2), 1};
    else
      p = {random_value(0, 1), random_value(0, 1), random_value(0, 1), 1};
  }
  scene.source = in_floats(scene.source);
  return scene;
}

/// What OpenColorIO makes of the picture.
DoubleImage by_ocio(const DoubleImage& source, const std::filesystem::path& file) {
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  const auto transform = OCIO::FileTransform::Create();
  transform->setSrc(file.c_str());
  transform->setInterpolation(file.extension() == ".clf" ? OCIO::INTERP_DEFAULT : OCIO::INTERP_TETRAHEDRAL);
  transform->setCCCId("0");
  const auto cpu = OCIO::Config::CreateRaw()->getProcessor(transform)->getOptimizedCPUProcessor(
      OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, OCIO::OPTIMIZATION_NONE);
  DoubleImage out = source;
  for (auto& p : out.pixels) {
    const Rgb straight = Rgb(p) / cover(p);
    float rgb[3] = {static_cast<float>(straight.r), static_cast<float>(straight.g), static_cast<float>(straight.b)};
    cpu->applyRGB(rgb);
    p = Rgba(glm::clamp(Rgb(rgb[0], rgb[1], rgb[2]), -1e30, 1e30) * cover(p), p.a);  // no effect returns more
  }
  return out;
}

void expect_close(const std::vector<float>& made, const DoubleImage& expected, const std::string& what) {
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double wanted = expected.pixels[i][c];
      const double error =
          std::abs(made[4 * i + static_cast<std::size_t>(c)] - wanted) / std::max(1.0, std::abs(wanted));
      if (!(error <= worst)) worst = error, at = i;
    }
  EXPECT_LE(worst, 1e-5) << what << ", pixel " << at << ": " << made[4 * at] << " " << made[4 * at + 1] << " "
                         << made[4 * at + 2] << ", expected " << expected.pixels[at].r << " " << expected.pixels[at].g
                         << " " << expected.pixels[at].b;
}

std::string entry(const std::string& file, const std::string& more = "input = \"linear\"") {
  return fmt::format("fx.lut {{ file = \"{}\", {} }}", file, more);
}

void agree_with_ocio(const std::string& name, const std::string& text) {
  SCOPED_TRACE(name);
  const auto file = write_test_file(name, text);
  const auto scene = colours();
  const auto expected = by_ocio(scene.source, file);
  const Made plain = run_stack(entry(name), scene, Way::plain);
  expect_close(plain.result, expected, "plain");
  EXPECT_TRUE(alpha_is_kept(plain, scene));
  expect_close(run_stack(entry(name), scene, Way::fused).result, expected, "fused");
}

TEST_F(Effects, LutCubesAgreeWithOpenColorIo) {
  for (const int size : {2, 3, 17, 33, 64})
    agree_with_ocio(
        fmt::format("cube{}.cube", size),
        fmt::format("TITLE \"random\"\n# comment\nLUT_3D_SIZE {}\n", size) + random_rows(size * size * size));
}

TEST_F(Effects, LutCurvesAgreeWithOpenColorIo) {
  for (const int size : {2, 5, 256, 1024, 65536})
    agree_with_ocio(fmt::format("curve{}.cube", size), fmt::format("LUT_1D_SIZE {}\n", size) + random_rows(size));
}

TEST_F(Effects, LutDomainsAgreeWithOpenColorIo) {
  agree_with_ocio("domain3.cube",
                  "LUT_3D_SIZE 9\nDOMAIN_MIN -0.25 0 0.125\nDOMAIN_MAX 1.5 4 0.75\n" + random_rows(729));
  agree_with_ocio("domain1.cube", "LUT_1D_SIZE 33\nDOMAIN_MIN -1 -0.5 0.1\nDOMAIN_MAX 2 1 8\n" + random_rows(33));
  agree_with_ocio("resolve.cube",
                  "LUT_1D_SIZE 65\nLUT_1D_INPUT_RANGE -0.5 2.0\nLUT_3D_SIZE 7\nLUT_3D_INPUT_RANGE 0.0 1.25\n" +
                      random_rows(65, 0, 1.25) + random_rows(343));
}

TEST_F(Effects, LutOtherFormatsAgreeWithOpenColorIo) {
  std::string rows = "Version 1\nFrom 0.0 1.5\nLength 40\nComponents 3\n{\n" + random_rows(40) + "}\n";
  agree_with_ocio("curve.spi1d", rows);
  std::string spi3d = "SPILUT 1.0\n3 3\n5 5 5\n";
  for (int r = 0; r < 5; ++r)
    for (int g = 0; g < 5; ++g)
      for (int b = 0; b < 5; ++b) spi3d += fmt::format("{} {} {} ", r, g, b) + random_rows(1);
  agree_with_ocio("cube.spi3d", spi3d);
  agree_with_ocio("shaper.csp",
                  "CSPLUTV100\n3D\n\n2\n0 2\n0 1\n2\n0 2\n0 1\n2\n0 1.5\n0 1\n\n3 3 3\n" + random_rows(27));
  agree_with_ocio(
      "grade.cdl",
      "<ColorDecisionList xmlns=\"urn:ASC:CDL:v1.01\"><ColorDecision><ColorCorrection id=\"a\"><SOPNode>"
      "<Slope>1.1 0.9 1.2</Slope><Offset>0.02 -0.03 0.01</Offset><Power>1.2 0.8 1.05</Power></SOPNode>"
      "<SatNode><Saturation>0.7</Saturation></SatNode></ColorCorrection></ColorDecision></ColorDecisionList>");
}

TEST_F(Effects, LutProcessListsAgreeWithOpenColorIo) {
  const auto process = [](const std::string& nodes) {
    return "<?xml version=\"1.0\"?><ProcessList id=\"p\" compCLFversion=\"3\">" + nodes + "</ProcessList>";
  };
  agree_with_ocio("steps.clf",
                  process("<Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 4\">0.9 0.1 0.05 0.01 0.2 0.7 "
                          "0.1 -0.02 0 0.3 0.8 0.03</Array></Matrix>"
                          "<Range inBitDepth=\"32f\" outBitDepth=\"32f\"><minInValue>0.1</minInValue><maxInValue>1.5"
                          "</maxInValue><minOutValue>0</minOutValue><maxOutValue>1</maxOutValue></Range>"
                          "<LUT1D inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"5 3\">" +
                          random_rows(5) + "</Array></LUT1D>"));
  for (const char* interpolation : {"trilinear", "tetrahedral"})
    agree_with_ocio(fmt::format("{}.clf", interpolation),
                    process(fmt::format("<LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\" interpolation=\"{}\"><Array "
                                        "dim=\"9 9 9 3\">{}</Array></LUT3D>",
                                        interpolation, random_rows(729))));
  std::string half;
  for (int i = 0; i < 65536; ++i) half += fmt::format("{:.5f}\n", std::sin(i * 0.001));
  agree_with_ocio("half.clf", process("<LUT1D inBitDepth=\"32f\" outBitDepth=\"32f\" halfDomain=\"true\"><Array "
                                      "dim=\"65536 1\">" +
                                      half + "</Array></LUT1D>"));
}

TEST_F(Effects, LutIdentityAndMixAreWhatTheySay) {
  std::string identity = "LUT_3D_SIZE 2\n";
  for (int b = 0; b < 2; ++b)
    for (int g = 0; g < 2; ++g)
      for (int r = 0; r < 2; ++r) identity += fmt::format("{} {} {}\n", r, g, b);
  write_test_file("identity.cube", identity);
  auto scene = random_scene({33, 17}, 72);
  for (auto& p : scene.source.pixels) p = Rgba(glm::min(Rgb(p), Rgb(1)), 1);  // tables see straight colour
  for (const char* encoding : {"linear", "srgb"})
    EXPECT_TRUE(
        agrees(run_stack(entry("identity.cube", fmt::format("input = \"{}\"", encoding)), scene, Way::plain).result,
               scene.source, 1e-5, kRgba))
        << encoding;
  for (auto& p : scene.source.pixels) p = Rgba(0.1 + 0.25 * Rgb(p), p.a);  // inside of AP1, below its 1
  scene.source = in_floats(scene.source);
  EXPECT_TRUE(agrees(run_stack(entry("identity.cube", "input = \"acescct\""), scene, Way::plain).result, scene.source,
                     2e-5, kRgba));

  const auto file = write_test_file("mix.cube", "LUT_3D_SIZE 3\n" + random_rows(27));
  auto expected = by_ocio(scene.source, file);
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    expected.pixels[i] = 0.75 * scene.source.pixels[i] + 0.25 * expected.pixels[i];
  expect_close(run_stack(entry("mix.cube", "input = \"linear\", intensity = 0.25"), scene, Way::plain).result, expected,
               "mix");
}

TEST_F(Effects, LutEncodesAsItSays) {
  const auto file = write_test_file("encoded.cube", "LUT_3D_SIZE 5\n" + random_rows(125, 0, 1));
  auto scene = random_scene({40, 30}, 73);
  for (auto& p : scene.source.pixels) p.a = 1;  // tables see straight colour
  DoubleImage encoded = scene.source;
  for (auto& p : encoded.pixels)
    for (int c = 0; c < 3; ++c) p[c] = linear_to_srgb(p[c]);
  auto expected = by_ocio(in_floats(encoded), file);
  for (auto& p : expected.pixels)
    for (int c = 0; c < 3; ++c) p[c] = srgb_to_linear(p[c]);
  const Made made = run_stack(entry("encoded.cube", "input = \"srgb\""), scene, Way::plain);
  EXPECT_TRUE(agrees(made.result, expected, 1e-4, kRgb));
  for (std::size_t i = 0; i < encoded.pixels.size(); ++i) encoded.pixels[i].a = scene.source.pixels[i].a;
  auto linear = by_ocio(in_floats(encoded), file);
  EXPECT_TRUE(
      agrees(run_stack(entry("encoded.cube", "input = \"srgb\", output = \"linear\""), scene, Way::plain).result,
             linear, 1e-4, kRgb));
}

TEST_F(Effects, LutJoinsItsNeighbours) {
  write_test_file("fused.cube", "LUT_3D_SIZE 4\n" + random_rows(64));
  const std::string entries =
      "fx.tone_mapping {}, fx.color_adjustments { post_exposure = 0.5 }, " + entry("fused.cube") + ", fx.film_grain {}";
  const Made fused = run_stack(entries, random_scene({32, 32}, 74), Way::fused);
  EXPECT_EQ(fused.graph.passes.size(), 4u);
  EXPECT_EQ(fused.kernels, 1u);
}

TEST_F(Effects, LutErrorsNameTheFileAndTheLine) {
  const auto scene = random_scene({8, 8}, 75);
  const auto error_of = [&](const std::string& text) {
    write_test_file("wrong.cube", text);
    return build_error(entry("wrong.cube"), scene);
  };
  EXPECT_THAT(error_of("LUT_3D_SIZE 1000000\n0 0 0\n"),
              testing::HasSubstr("wrong.cube:1: error: LUT_3D_SIZE is 1000000"));
  EXPECT_THAT(error_of("LUT_3D_SIZE 2\n0 0 0\n0 nan 0\n"), testing::HasSubstr("wrong.cube:3: error: 'nan' is not"));
  EXPECT_THAT(error_of("LUT_3D_SIZE 2\n0 0 0\n"), testing::HasSubstr("ends after 1 of 8 colours"));
  EXPECT_THAT(build_error(entry("wrnog.cube"), scene), testing::HasSubstr("did you mean 'wrong.cube'"));
  EXPECT_THAT(build_error(entry("wrnog.cube"), scene), testing::HasSubstr(".lua:3: error: file = \"wrnog.cube\""));
  EXPECT_THAT(build_error(entry("../wrong.cube"), scene), testing::HasSubstr("not a name inside"));
  EXPECT_THAT(build_error(entry("/etc/passwd.cube"), scene), testing::HasSubstr("not a name inside"));
  EXPECT_THAT(build_error(entry("picture.png"), scene), testing::HasSubstr("no file of a kind that is allowed"));
  std::filesystem::create_symlink("/etc/passwd", test_files() / "link.cube");
  EXPECT_THAT(build_error(entry("link.cube"), scene), testing::HasSubstr("is a link that leads out of"));
}

}  // namespace
}  // namespace afterglow
