// SPDX-License-Identifier: MIT
// Colour spaces that tables are made for: shaders, what reads pictures, and the oracle, against each other and against
// the values that colour-science publishes.
#include <OpenColorIO/OpenColorIO.h>

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "files.h"
#include "harness.h"
#include "image/input_space.h"
#include "reference/transfer.h"

namespace OCIO = OCIO_NAMESPACE;

namespace afterglow {
namespace {

using namespace reference;

struct PublishedCode {
  const char* space;
  double light, code, tolerance;
};

// Tests of colour-science 0.4: log_encoding_ACEScct, log_encoding_ARRILogC3 (0.3: log_encoding_ALEXALogC),
// log_encoding_ARRILogC4, log_encoding_SLog3, eotf_inverse_ST2084 (of cd/m²), oetf_BT2100_HLG (constants of eight
// digits).
const PublishedCode kPublished[] = {
    {"acescct", 0, 0.072905534195835495, 1e-12},  {"acescct", 0.18, 0.413588402492442, 1e-12},
    {"acescct", 1, 0.554794520547945, 1e-12},     {"logc3", 0, 0.092809, 1e-12},
    {"logc3", 0.18, 0.391006832034084, 1e-12},    {"logc3", 1, 0.570631558120417, 1e-12},
    {"logc4", 0, 0.092864125122190, 1e-12},       {"logc4", 0.18, 0.278395836548265, 1e-12},
    {"logc4", 1, 0.427519364835306, 1e-12},       {"slog3", 0, 0.092864125122189639, 1e-12},
    {"slog3", 0.18, 0.41055718475073316, 1e-12},  {"slog3", 1, 0.59602734369012345, 1e-12},
    {"pq", 0, 0.000000730955903, 1e-12},          {"pq", 100.0 / 203, 0.508078421517399, 1e-12},
    {"pq", 400.0 / 203, 0.652578597563067, 1e-12}};

TEST(Transfer, PublishedValues) {
  for (const auto& v : kPublished) {
    EXPECT_NEAR(light_to_transfer(v.space, v.light), v.code, v.tolerance) << v.space << " " << v.light;
    EXPECT_NEAR(transfer_to_light(v.space, v.code), v.light, 1e-9) << v.space << " " << v.code;
  }
  const double white = transfer_to_light("hlg", 1);  // is the light 1 of the paper
  EXPECT_NEAR(light_to_transfer("hlg", white * 0.18 / 12), 0.212132034355964, 1e-8);
  EXPECT_NEAR(light_to_transfer("hlg", white), 0.999999995536569, 1e-8);
  EXPECT_NEAR(light_to_transfer("hlg", 1), 0.75, 1e-12);
}

TEST(Transfer, IsWhatPicturesAreReadBy) {
  for (const InputSpace& space : input_spaces()) {
    const std::string name = space.name;  // below 0 sRGB says nothing, and PQ has no codes
    for (double v = name == "pq" || name == "srgb" || name == "display_p3" ? 0 : -0.25; v <= 1; v += 1.0 / 512) {
      const double light = transfer_to_light(space.name, v);
      EXPECT_NEAR(space.to_linear(v), light, 2e-8 * std::max(1.0, light)) << space.name << " " << v;
    }
    ColorEncoding encoding;
    use_input_space(space, encoding);
    const Rgb stored(0.4, 0.5, 0.3);
    Rgb curve(space.to_linear(stored.r), space.to_linear(stored.g), space.to_linear(stored.b));
    if (space.hlg_display) curve *= std::pow(0.2627 * curve.r + 0.6780 * curve.g + 0.0593 * curve.b, 0.2);
    const Rgb light = transfer_to_rec709(space.name, stored);
    for (int row = 0; row < 3; ++row) {
      double sum = curve[row];
      if (encoding.matrix) {
        const auto& m = (*encoding.matrix)[static_cast<std::size_t>(row)];
        sum = m[0] * curve.r + m[1] * curve.g + m[2] * curve.b;
      }
      EXPECT_NEAR(sum, light[row], 1e-8) << space.name;
    }
  }
  EXPECT_EQ(input_spaces().size(), transfer_names().size());
}

TEST(Transfer, GoesBackAndRises) {
  for (const auto& name : transfer_names()) {
    double before = -1;
    for (double light = 1e-6; light < 40; light *= 1.02) {
      const double code = light_to_transfer(name, light);
      EXPECT_GT(code, before) << name << " " << light;
      EXPECT_NEAR(transfer_to_light(name, code), light, 1e-9 * std::max(1.0, light)) << name << " " << light;
      before = code;
    }
  }
}

/// Curves and primaries of cameras by OpenColorIO's own, which goes to ACES2065-1 as each maker's transform does.
TEST(Transfer, CamerasAreThoseOfOpenColorIo) {
  const auto xyz = [](double x, double y) { return Rgb(x / y, 1, (1 - x - y) / y); };
  const glm::dmat3 ap0 = glm::transpose(glm::dmat3(0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966,
                                                   -0.0721325464, 0, 0, 1.0088251844));  // written by rows
  const auto adapted = [&](const glm::dmat3& by_rows) {
    const glm::dmat3 cones = glm::transpose(by_rows);
    const Rgb gain = (cones * xyz(0.3127, 0.3290)) / (cones * xyz(0.32168, 0.33767));
    return glm::inverse(cones) * glm::dmat3(gain.r, 0, 0, 0, gain.g, 0, 0, 0, gain.b) * cones;
  };
  const glm::dmat3 cat02 = adapted({0.7328, 0.4296, -0.1624, -0.7036, 1.6975, 0.0061, 0.0030, 0.0136, 0.9834});
  const glm::dmat3 bradford = adapted({0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296});
  const glm::dmat3 to_709 =
      glm::transpose(glm::dmat3(3.2409699419, -1.5373831776, -0.4986107603, -0.9692436363, 1.8759675015, 0.0415550574,
                                0.0556300797, -0.2039769589, 1.0569715142));
  for (const auto& [name, style, white] : {std::tuple("vlog", "PANASONIC_VLOG-VGAMUT_to_ACES2065-1", bradford),
                                           {"clog2", "CANON_CLOG2-CGAMUT_to_ACES2065-1", cat02},
                                           {"clog3", "CANON_CLOG3-CGAMUT_to_ACES2065-1", cat02},
                                           {"log3g10", "RED_LOG3G10-RWG_to_ACES2065-1", bradford},
                                           {"slog3", "SONY_SLOG3-SGAMUT3.CINE_to_ACES2065-1", cat02},
                                           {"slog3_sgamut3", "SONY_SLOG3-SGAMUT3_to_ACES2065-1", cat02},
                                           {"logc3", "ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1", cat02}}) {
    const auto transform = OCIO::BuiltinTransform::Create();
    transform->setStyle(style);
    const auto cpu =
        OCIO::Config::CreateRaw()->getProcessor(transform)->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_NONE);
    for (const Rgb& stored :
         {Rgb(0.02), Rgb(0.11), Rgb(0.13), Rgb(0.2), Rgb(0.4), Rgb(0.7), Rgb(0.5, 0.4, 0.3), Rgb(0.3, 0.5, 0.6)}) {
      float rgb[3] = {static_cast<float>(stored.r), static_cast<float>(stored.g), static_cast<float>(stored.b)};
      cpu->applyRGB(rgb);
      const Rgb expected = to_709 * (white * (ap0 * Rgb(rgb[0], rgb[1], rgb[2])));
      const Rgb light = transfer_to_rec709(name, stored);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[c], expected[c], 3e-5 * std::max(1.0, std::abs(expected[c])))
            << name << " " << stored.r << " " << c;
    }
  }
}

/// A table that changes nothing and ends nowhere.
void write_plain_tables() {
  write_test_file("plain.clf",
                  "<?xml version=\"1.0\"?><ProcessList id=\"p\" compCLFversion=\"3\"><Matrix inBitDepth=\"32f\" "
                  "outBitDepth=\"32f\"><Array dim=\"3 3\">1 0 0 0 1 0 0 0 1</Array></Matrix></ProcessList>\n");
}

std::string through(const std::string& input, const std::string& output) {
  return "fx.lut { file = \"plain.clf\", input = \"" + input + "\", output = \"" + output + "\" }";
}

Scene colours_of(double low, double high, bool logarithmic) {
  std::mt19937 random(77);
  const auto any = [&] {
    const double v = std::uniform_real_distribution(low, high)(random);
    return logarithmic ? std::exp2(v) : v;
  };
  Scene scene{"colours", DoubleImage(48, 48), {}, {}};
  for (auto& p : scene.source.pixels) p = Rgba(any(), any(), any(), 1);
  scene.source = in_floats(scene.source);
  return scene;
}

TEST_F(Effects, LutSpacesAreThoseOfTheOracle) {
  write_plain_tables();
  const Scene light = colours_of(-14, 5, true), codes = colours_of(0.02, 0.98, false);
  for (const auto& name : table_spaces()) {
    DoubleImage expected = light.source;
    for (auto& p : expected.pixels) p = Rgba(rec709_to_transfer(name, Rgb(p)), 1);
    for (const Way way : {Way::fused}) {
      EXPECT_TRUE(agrees(run_stack(through(name, "linear"), light, way).result, expected, 2e-5, kRgb)) << "to " << name;
      DoubleImage back = codes.source;
      for (auto& p : back.pixels) p = Rgba(transfer_to_rec709(name, Rgb(p)), 1);
      // Of colours whose channels are far apart, the smallest is a difference of large numbers.
      const Made made = run_stack(through("linear", name), codes, way);
      for (std::size_t i = 0; i < back.pixels.size(); ++i) {
        const Rgb wanted(back.pixels[i]);
        const double size =
            std::max(0.01, glm::max(std::abs(wanted.r), glm::max(std::abs(wanted.g), std::abs(wanted.b))));
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(double(made.result[4 * i + static_cast<std::size_t>(c)]), wanted[c], 3e-5 * size)
              << "from " << name;
      }
    }
  }
}

// Not fused, as that is compared with the oracle above: kernels of several rows take seven times as long to compile.
TEST_F(Effects, LutSpacesGoThereAndBack) {
  write_plain_tables();
  const Scene light = colours_of(-10, 1.5, true);
  for (const auto& name : table_spaces()) {
    const Made made = run_stack(through(name, "same"), light, Way::plain);
    for (std::size_t i = 0; i < light.source.pixels.size(); ++i) {
      const Rgb wanted(light.source.pixels[i]);
      const double size = glm::max(wanted.r, glm::max(wanted.g, wanted.b));
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(double(made.result[4 * i + static_cast<std::size_t>(c)]), wanted[c], 4e-5 * std::max(size, 0.01))
            << name;
    }
  }
}

TEST_F(Effects, LutSpacesRiseAndStayFiniteAtTheirEnds) {
  write_plain_tables();
  Scene greys{"greys", DoubleImage(64, 2), {}, {}};
  for (int x = 0; x < 64; ++x) {
    greys.source.at(x, 0) = Rgba(Rgb(std::exp2(-16 + x * 0.33)), 1);
    greys.source.at(x, 1) = Rgba(Rgb((x % 2 ? 1 : -1) * std::exp2(-30 + x * 2.0)), 1);  // up to 1e29
  }
  greys.source = in_floats(greys.source);
  for (const auto& name : table_spaces()) {
    for (const char* output : {"linear", "same"}) {
      const Made made = run_stack(through(name, output), greys, Way::plain);
      EXPECT_TRUE(all_finite(made.result)) << name;
      for (std::size_t x = 1; x < 64; ++x)
        EXPECT_GE(made.result[4 * x + 1], made.result[4 * x - 3] * 0.99999F) << name << " " << output << " " << x;
    }
    EXPECT_TRUE(all_finite(run_stack(through("linear", name), greys, Way::plain).result)) << name;
  }
}

}  // namespace
}  // namespace afterglow
