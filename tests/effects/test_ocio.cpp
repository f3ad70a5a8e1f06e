// SPDX-License-Identifier: MIT
// Views of OpenColorIO's configurations: against its CPU processor.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <random>

#include "files.h"
#include "harness.h"
#include "ocio_studio.h"
#include "reference/color.h"

namespace OCIO = OCIO_NAMESPACE;

namespace afterglow {
namespace {

using namespace reference;

/// Light of all kinds: below black, black, all but black, bright; every three of them together, and what lies between.
Scene wide_light() {
  static constexpr double kLevels[] = {-1, -0.1, -1e-4, 0, 1e-8, 1e-5, 1e-3, 0.02, 0.18, 0.5, 1, 2, 10, 100};
  constexpr std::size_t n = std::size(kLevels);
  std::mt19937 random(91);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Scene scene{"wide light", DoubleImage(64, 64), {}, {}};
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i) {
    auto& p = scene.source.pixels[i];
    const double level = any(-10, 6);
    p = i < n * n * n ? Rgba(kLevels[i % n], kLevels[i / n % n], kLevels[i / n / n], 1)
                      : Rgba(std::exp2(level + any(-1, 1)), std::exp2(level), std::exp2(level + any(-2, 2)), 1);
  }
  scene.source = in_floats(scene.source);
  return scene;
}

/// An effect that shows what g:ocio makes and nothing else.
void write_view_effect() {
  write_test_file("effects/ocio_view.lua", R"(local fx = require "afterglow"
return fx.effect { name = "ocio_view",
  settings = { config = fx.file { extensions = { "ocio" }, doc = "c" }, view = fx.text { doc = "v" }, from = fx.text { doc = "f" },
    to = fx.text { doc = "t" }, looks = fx.text { doc = "l" }, inverse = fx.bool { default = false, doc = "i" } },
  build = function(g, s, source)
    local made = g:ocio { config = s.config, view = s.view, from = s.from, to = s.to ~= "" and s.to or nil, looks = s.looks, inverse = s.inverse }
    return g:pass { shader = made.shader, source = source, table = made.table }
  end })");
}

using Flags = OCIO::OptimizationFlags;

std::vector<float> by_cpu(const OCIO::ConstProcessorRcPtr& processor, const Scene& scene, Flags flags) {
  const auto cpu = processor->getOptimizedCPUProcessor(flags);
  std::vector<float> out;
  for (const auto& p : scene.source.pixels) {
    float rgb[3] = {static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b)};
    cpu->applyRGB(rgb);
    out.insert(out.end(), rgb, rgb + 3);
  }
  return out;
}

OCIO::ConstProcessorRcPtr view_processor(const std::filesystem::path& file, const char* from, const char* display,
                                         const std::string& view) {
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  OCIO::ClearAllCaches();
  const auto shown = OCIO::DisplayViewTransform::Create();
  shown->setSrc(from);
  shown->setDisplay(display);
  shown->setView(view.c_str());
  return OCIO::Config::CreateFromFile(file.c_str())->getProcessor(shown);
}

struct Off {
  double most = 0;
  std::size_t pixel = 0;
  std::string text;
};

/// Largest difference: of codes, and beyond 1 of parts of them.
Off off_by(const std::vector<float>& made, const std::vector<float>& expected) {
  Off out;
  for (std::size_t i = 0; i < expected.size() / 3; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double wanted = double(expected[3 * i + c]), got = double(made[4 * i + c]);
      const double off = std::abs(got - wanted) / std::max(1.0, std::abs(wanted));
      if (!(off <= out.most)) {
        out = {off, i, fmt::format("pixel {} channel {}: {} instead of {}", i, c, got, wanted)};
      }
    }
  return out;
}

void expect_view(const std::filesystem::path& file, const char* from, const char* display, const std::string& view,
                 const Scene& scene) {
  const auto processor = view_processor(file, from, display, view);
  const auto exact = by_cpu(processor, scene, OCIO::OPTIMIZATION_LOSSLESS);
  const auto usual = by_cpu(processor, scene, OCIO::OPTIMIZATION_DEFAULT);
  const std::string entry =
      fmt::format("fx.ocio_view {{ config = \"{}\", view = \"{}\" }}", file.filename().string(), view);
  const Made plain = run_stack(entry, scene, Way::plain), fused = run_stack(entry, scene, Way::fused);
  const Off to_exact = off_by(plain.result, exact), to_usual = off_by(plain.result, usual);
  std::vector<float> usual4;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    usual4.push_back(usual[i]);
    if (i % 3 == 2) usual4.push_back(1);
  }
  fmt::print("| {} | {:.1e} | {:.1e} | {:.1e} |\n", view, to_usual.most, to_exact.most, off_by(usual4, exact).most);
  EXPECT_LE(to_usual.most, 1e-4) << view << ": " << to_usual.text;
  const Off of_joined = off_by(fused.result, usual);
  EXPECT_LE(of_joined.most, 1e-4) << view << ", fused: " << of_joined.text;
}

TEST_F(Effects, OcioViewsAreWithinATenThousandthOfTheCpuProcessor) {
  write_view_effect();
  const auto file = write_studio();
  const Scene scene = wide_light();
  fmt::print(
      "| view | to its CPU processor | to the same without approximations | between these two |\n|---|---|---|---|\n");
  for (const auto& view : studio_views()) expect_view(file, "lin_rec709", "Monitor", view, scene);
}

TEST_F(Effects, OcioConfigurationsOfVersion1AreToo) {
  write_view_effect();
  const auto file = write_old_studio();
  const Scene scene = wide_light();
  for (const char* view : {"Film", "Log", "Looked", "Raw"}) expect_view(file, "lin_srgb", "Old", view, scene);
}

/// What the transform makes of the scene on the CPU, by a processor of the studio's configuration.
std::vector<float> by_studio(const OCIO::ConstTransformRcPtr& transform, OCIO::TransformDirection direction,
                             const Scene& scene) {
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  OCIO::ClearAllCaches();
  const auto config = OCIO::Config::CreateFromFile(write_studio().c_str());
  return by_cpu(config->getProcessor(transform, direction), scene, OCIO::OPTIMIZATION_DEFAULT);
}

// An output encodes light with the sRGB curve, and the codes are those of the view.
TEST_F(Effects, OcioDisplayMakesLightThatIsEncodedIntoTheViewsCodes) {
  const Scene scene = wide_light();
  for (const char* view : {"ACES", "film"}) {
    const auto expected =
        by_cpu(view_processor(write_studio(), "lin_rec709", "Monitor", view), scene, OCIO::OPTIMIZATION_DEFAULT);
    const Made made = run_stack(fmt::format("fx.ocio_display {{ config = \"studio.ocio\", view = \"{}\" }}", view),
                                scene, Way::fused);
    std::vector<float> codes;
    for (const float v : made.result) codes.push_back(static_cast<float>(linear_to_srgb(std::max(double(v), 0.0))));
    std::vector<float> shown;
    for (const float v : expected) shown.push_back(std::max(v, 0.0F));
    const Off off = off_by(codes, shown);
    EXPECT_LE(off.most, 1e-4) << view << ": " << off.text;
    EXPECT_GT(off_by(made.result, shown).most, 0.1) << "the codes themselves";
    EXPECT_TRUE(alpha_is_kept(made, scene));
  }
}

TEST_F(Effects, OcioTransformGoesBetweenSpacesThroughLooksAndBack) {
  const Scene scene = wide_light();
  const auto change = OCIO::ColorSpaceTransform::Create();
  change->setSrc("lin_rec709");
  change->setDst("log camera");
  const auto look = OCIO::LookTransform::Create();
  look->setSrc("lin_rec709");
  look->setDst("lin_rec709");
  look->setLooks("+contrast");
  Scene codes = scene;  // where logarithms have theirs
  for (auto& p : codes.source.pixels) p = glm::min(p, Rgba(1));
  codes.source = in_floats(codes.source);
  const auto agree = [&](const std::string& settings, const std::vector<float>& expected, bool of_codes = false) {
    const Off off = off_by(run_stack("fx.ocio_transform { config = \"studio.ocio\", " + settings + " }",
                                     of_codes ? codes : scene, Way::fused)
                               .result,
                           expected);
    EXPECT_LE(off.most, 1e-4) << settings << ": " << off.text;
  };
  agree("to = \"log camera\"", by_studio(change, OCIO::TRANSFORM_DIR_FORWARD, scene));
  agree("from = \"lin_rec709\", to = \"log camera\"", by_studio(change, OCIO::TRANSFORM_DIR_FORWARD, scene));
  agree("from = \"log camera\"", by_studio(change, OCIO::TRANSFORM_DIR_INVERSE, codes), true);
  agree("to = \"log camera\", inverse = true", by_studio(change, OCIO::TRANSFORM_DIR_INVERSE, codes), true);
  agree("looks = \"contrast\"", by_studio(look, OCIO::TRANSFORM_DIR_FORWARD, scene));
  look->setLooks("-contrast");
  agree("looks = \"-contrast\"", by_studio(look, OCIO::TRANSFORM_DIR_FORWARD, scene));
  EXPECT_EQ(run_stack("fx.ocio_transform {}", scene, Way::plain).graph.skipped.at(0).reason,
            "neither spaces nor looks are given");
}

// A configuration without a name for linear Rec.709 is asked by way of ACES2065-1.
TEST_F(Effects, OcioFindsTheWorkingSpaceByItsRole) {
  const Scene scene = wide_light();
  std::string text;
  {
    std::ifstream in(write_studio());
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  for (std::size_t at; (at = text.find("lin_rec709")) != std::string::npos;) text.replace(at, 10, "lin_other");
  text.insert(text.find("    - !<View> {name: ACES,"), "    - !<View> {name: Numbers, colorspace: numbers}\n");
  text += "  - !<ColorSpace> {name: numbers, isdata: true}\n";
  write_test_file("nameless.ocio", text);
  write_old_studio();
  const std::string settings = "view = \"log affine\" }";
  const auto by_name = run_stack("fx.ocio_display { config = \"studio.ocio\", " + settings, scene, Way::plain).result;
  const auto by_role = run_stack("fx.ocio_display { config = \"nameless.ocio\", " + settings, scene, Way::plain).result;
  for (std::size_t i = 0; i < by_name.size(); ++i)
    EXPECT_NEAR(by_role[i], by_name[i], 1e-5 * std::max(1.0F, std::abs(by_name[i])));
  // Data are nobody's colours: no matrix stands before or behind them.
  std::vector<float> as_it_is;
  for (const auto& pixel : scene.source.pixels)
    for (int c = 0; c < 4; ++c) as_it_is.push_back(static_cast<float>(pixel[c]));
  for (const char* change : {"to = \"numbers\"", "from = \"numbers\""}) {
    const Made made =
        run_stack(fmt::format("fx.ocio_transform {{ config = \"nameless.ocio\", {} }}", change), scene, Way::plain);
    for (std::size_t i = 0; i < as_it_is.size(); ++i)
      EXPECT_NEAR(made.result[i], as_it_is[i], 1e-6 * std::max(1.0F, std::abs(as_it_is[i]))) << change;
  }
  const auto numbers = [&](const std::string& config, const std::string& view) {
    return run_stack(fmt::format("fx.ocio_display {{ config = \"{}\", view = \"{}\" }}", config, view), scene,
                     Way::plain)
        .result;
  };
  const auto raw = numbers("nameless.ocio", "Numbers");
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const double want = i % 4 == 3 ? as_it_is[i] : srgb_to_linear(as_it_is[i]);
    EXPECT_NEAR(raw[i], want, 1e-4 * std::max(1.0, std::abs(want)));
  }
  EXPECT_THAT(build_error("fx.ocio_display { config = \"old.ocio\", from = \"raww\" }", scene),
              testing::HasSubstr("did you mean 'raw'?"));
}

}  // namespace
}  // namespace afterglow
