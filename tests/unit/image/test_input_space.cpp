// SPDX-License-Identifier: MIT
// Colour spaces of cameras and broadcast, against the values that their makers publish.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "image/input_space.h"

namespace afterglow {
namespace {

double light(const char* space, double stored) { return (*find_input_space(space))->to_linear(stored); }

struct Published {
  const char* space;
  double stored, light, tolerance;
};

// Middle grey, black and white as the specifications state them; digits beyond are colour-science 0.4's.
TEST(InputSpace, PublishedValues) {
  const Published values[] = {
      {"acescct", 0.4135884024924423, 0.18, 1e-9},   // S-2016-001: ACEScct of 0.18
      {"acescct", 0.0729055341958355, 0, 1e-12},     // of 0
      {"acescct", 0.554794520547945, 1, 1e-9},       // (log2(1) + 9.72)/17.52
      {"logc3", 0.391006832034084, 0.18, 1e-8},      // ARRI: 18 % grey is the 10-bit code 400
      {"logc3", 0.092809, 0, 1e-12},                 // f
      {"logc3", 1, 55.0796, 1e-3},                   // ARRI's table for EI 800: the maximum is 55.08
      {"logc4", 0.278395836548265, 0.18, 1e-9},      // ARRI: 18 % grey is 27.84 %
      {"logc4", 0.0928641251221896, 0, 1e-9},        // of 0: 95/1023
      {"logc4", 1, 469.8, 1e-9},                     // the end: 117.45 times 4
      {"slog3", 0.410557184750733, 0.18, 1e-9},      // Sony: 18 % is the 10-bit code 420
      {"slog3", 0.0928641251221896, 0, 1e-12},       // 0 % is 95
      {"slog3", 598.0 / 1023, 0.9, 0.003},           // 90 % is 598
      {"pq", 0.508078421517399, 100.0 / 203, 1e-9},  // ST 2084: 100 cd/m²
      {"pq", 0.149945886547, 1.0 / 203, 1e-6},       // 1 cd/m²
      {"pq", 1, 10000.0 / 203, 1e-9},                // the maximum
      {"pq", 0, 0, 1e-12},
      {"hlg", 0.75, 1, 1e-12},
      {"hlg", 0.5, (1.0 / 12) / 0.264962560, 1e-6},  // BT.2100: E = 1/12 at half of the signal
      {"hlg", 1, 1 / 0.264962560, 1e-5},             // and 1 at its end
      {"vlog", 0.125, 0, 1e-12},                     // Panasonic: 0 % is the 10-bit code 128
      {"vlog", 433.0 / 1023, 0.18, 1e-3},            // 18 % is 433
      {"vlog", 602.0 / 1023, 0.9, 5e-3},             // 90 % is 602
      {"clog2", 0.092864125, 0, 1e-12},
      {"clog2", 0.398254692, 0.18, 1e-5},
      {"clog3", 0.12512219, 0, 1e-12},
      {"clog3", 0.343389, 0.18, 1e-4},
      {"log3g10", 1.0 / 3, 0.18, 1e-6},  // RED: 18 % is a third
      {"log3g10", 1, 184.322, 1e-3},     // and the end
      {"log3g10", 0.091551, 0, 1e-6},
      {"davinci_intermediate", 0.336043, 0.18, 1e-6},  // Blackmagic's table of 2021
      {"davinci_intermediate", 0.513837, 1, 1e-5},
      {"davinci_intermediate", 1, 100, 1e-4},
      {"bmd_film5", 28.0 / 73, 0.18, 1e-12},
      {"apple_log", 0.488272458526868, 0.18, 1e-9},
      {"apple_log", 1, 12, 1e-5},
      {"gamma22", 0.5, 0.217637640824031, 1e-12},
      {"gamma24", 0.5, 0.189464570814019, 1e-12},
      {"srgb", 0.5, 0.214041140482232, 1e-9},
  };
  for (const auto& v : values)
    EXPECT_NEAR(light(v.space, v.stored), v.light, v.tolerance) << v.space << " " << v.stored;
}

TEST(InputSpace, CurvesRiseAndAreWholeAtTheirBreaks) {
  for (const InputSpace& space : input_spaces()) {
    double before = space.to_linear(0);
    for (double v = 1e-4; v <= 1; v += 1e-4) {
      const double here = space.to_linear(v);
      EXPECT_GE(here, before) << space.name << " " << v;
      const bool root = std::string_view(space.name) == "apple_log" && v < 0.01;  // as steep as one rises at its end
      if (!root) {
        EXPECT_LT(here - before, 5e-3 * std::max(here, 0.05)) << space.name << " " << v;
      }
      before = here;
    }
  }
}

TEST(InputSpace, WhiteStaysGreyAndPrimariesAreTheMakers) {
  for (const InputSpace& space : input_spaces()) {
    ColorEncoding encoding;
    use_input_space(space, encoding);
    if (!encoding.matrix) continue;
    for (const auto& row : *encoding.matrix) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-6) << space.name;
  }
  // Rec.2020 to Rec.709 as ITU-R BT.2407 prints it.
  ColorEncoding encoding;
  use_input_space(**find_input_space("pq"), encoding);
  EXPECT_NEAR((*encoding.matrix)[0][0], 1.6605, 5e-5);
  EXPECT_NEAR((*encoding.matrix)[1][0], -0.1246, 5e-5);
  EXPECT_NEAR((*encoding.matrix)[2][2], 1.1187, 5e-5);
  // ALEXA Wide Gamut 3 to Rec.709 as ARRI prints it.
  use_input_space(**find_input_space("logc3"), encoding);
  EXPECT_NEAR((*encoding.matrix)[0][0], 1.617523, 2e-5);
  EXPECT_NEAR((*encoding.matrix)[0][1], -0.537287, 2e-5);
  EXPECT_NEAR((*encoding.matrix)[2][1], -0.226954, 2e-5);
}

TEST(InputSpace, LinearLightOfOtherPrimaries) {
  const auto matrix = [](const char* name) {
    ColorEncoding encoding;
    use_input_space(*find_input_space(name).value(), encoding);
    EXPECT_EQ(encoding.curve, TransferCurve::linear) << name;
    return encoding.matrix.value();
  };
  // As ACES publishes them: Bradford from the white of ACES to D65.
  EXPECT_NEAR(matrix("acescg")[0][0], 1.70505, 2e-5);
  EXPECT_NEAR(matrix("acescg")[1][2], -0.01055, 2e-5);
  EXPECT_NEAR(matrix("aces2065_1")[0][0], 2.52169, 2e-5);
  EXPECT_NEAR(matrix("aces2065_1")[2][1], -0.15298, 2e-5);
  // ITU-R BT.2087 has this one's inverse.
  EXPECT_NEAR(matrix("lin_rec2020")[0][0], 1.66049, 2e-5);
  EXPECT_NEAR(matrix("lin_p3d65")[0][0], 1.22494, 2e-5);
}

/// What a display of 1000 cd/m² shows of HLG (ITU-R BT.2100, table 5, with gamma 1.2): greys by BT.2408's white, and a
/// colour by the formula of the table.
TEST(InputSpace, HlgOfADisplayIsItsLight) {
  ColorEncoding encoding;
  use_input_space(**find_input_space("hlg_1000"), encoding);
  encoding.matrix.reset();  // in Rec.2020
  const auto scene = [](double v) {
    return v <= 0.5 ? v * v / 3 : (std::exp((v - 0.55991073) / 0.17883277) + 0.28466892) / 12;
  };
  for (const auto& [r, g, b] :
       {std::array{0.75, 0.75, 0.75}, {1.0, 1.0, 1.0}, {0.38, 0.38, 0.38}, {0.9, 0.2, 0.4}, {0.0, 0.0, 0.0}}) {
    std::array<float, 4> pixel{static_cast<float>(r), static_cast<float>(g), static_cast<float>(b), 1};
    SanitizeCounts counts;
    decode_color(encoding, pixel.data(), 1, counts);
    const double luminance = 0.2627 * scene(r) + 0.6780 * scene(g) + 0.0593 * scene(b);
    const double gain = luminance > 0 ? 1000 * std::pow(luminance, 0.2) : 0;
    EXPECT_NEAR(pixel[0] * 203, gain * scene(r), 1e-3) << r;
    EXPECT_NEAR(pixel[1] * 203, gain * scene(g), 1e-3) << r;
    EXPECT_NEAR(pixel[2] * 203, gain * scene(b), 1e-3) << r;
    const double published = r == 0.75   ? 203
                             : r == 0.38 ? 26
                             : r == 1    ? 1000
                                         : 0;  // BT.2408: white, 18 % grey; the peak
    if (published > 0) {
      EXPECT_NEAR(pixel[0] * 203, published, published / 50);
    }
  }
}

TEST(InputSpace, UnknownNamesAreTold) {
  const auto found = find_input_space("logc");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().text(),
            "error: 'logc' is no input space; allowed: aces2065_1, acescct, acescg, adobe_rgb, apple_log, bmd_film5, "
            "cineon, clog2, clog3, davinci_intermediate, display_p3, gamma22, gamma24, hlg, hlg_1000, lin_p3d65, "
            "lin_rec2020, linear, log3g10, logc3, logc4, pq, rec709, slog3, slog3_sgamut3, srgb, vlog; did you mean "
            "'logc3'?");
}

TEST(InputSpace, XyzIsReadWithoutInventingAdaptation) {
  // The white of a scene under D65, stored as XYZ: it is white, not 12 % too blue.
  const Matrix3 matrix = to_rec709({{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}});
  const std::array<double, 3> white{0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  for (const auto& row : matrix) EXPECT_NEAR(row[0] * white[0] + row[1] * white[1] + row[2] * white[2], 1, 1e-12);
  // Other primaries under other whites are adapted.
  const Matrix3 ap0 = to_rec709({{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}});
  for (const auto& row : ap0) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-9);
}

}  // namespace
}  // namespace afterglow
