// SPDX-License-Identifier: MIT
// Tables of displays against OpenColorIO's and Little CMS' own processors, in floats.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lcms2.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "image/display_table.h"
#include "temporary_folder.h"

namespace OCIO = OCIO_NAMESPACE;

namespace afterglow {
namespace {

using Light = std::array<float, 3>;
using Exactly = std::function<void(float* rgb)>;

/// As docs/player.md says: a luminance, red and blue up to two stops from it; `outside`: with a channel below 0.
std::vector<Light> usual_light(double most_stop, bool outside) {
  std::mt19937 random(7);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  std::vector<Light> out;
  for (int i = 0; i < 20000; ++i) {
    const double stop = any(-12, most_stop);
    Light c{static_cast<float>(std::exp2(stop + any(-2, 2))), static_cast<float>(std::exp2(stop)),
            static_cast<float>(std::exp2(stop + any(-2, 2)))};
    if (outside) c[static_cast<std::size_t>(i % 3)] *= -0.1f;
    out.push_back(c);
  }
  return out;
}

/// From black up, and a little below.
std::vector<Light> greys(double most) {
  std::vector<Light> out;
  for (int i = -100; i <= 4000; ++i) {
    const double u = i / 4000.0;
    const auto v = static_cast<float>(most * u * u * u * (u < 0 ? 64 : 1));
    out.push_back({v, v, v});
  }
  return out;
}

struct Off {
  double most = 0, mean = 0;
};

/// In codes of 8 bits.
Off off_by(const DisplayTable& table, const std::vector<Light>& colors, const Exactly& exactly) {
  Off out;
  for (const Light& light : colors) {
    Light wanted = light;
    exactly(wanted.data());
    const auto got = read_display_table(table, {light[0], light[1], light[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = 255 * std::abs(got[c] - std::clamp(static_cast<double>(wanted[c]), 0.0, 1.0));
      out.most = std::max(out.most, error);
      out.mean += error / (3.0 * static_cast<double>(colors.size()));
    }
  }
  return out;
}

struct Bounds {
  double most, mean, grey, outside;  ///< `outside`: mean of those with a channel below 0
};

void expect_near(const DisplayTable& table, double most_stop, const Exactly& exactly, const Bounds& bounds) {
  const Off usual = off_by(table, usual_light(most_stop, false), exactly);
  const Off outside = off_by(table, usual_light(most_stop, true), exactly);
  const Off grey = off_by(table, greys(std::exp2(most_stop)), exactly);
  fmt::print("| {} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {:.3f} |\n", table.name, usual.most, usual.mean, grey.most,
             outside.most, outside.mean);
  EXPECT_LE(usual.most, bounds.most) << table.name;
  EXPECT_LE(usual.mean, bounds.mean) << table.name;
  EXPECT_LE(grey.most, bounds.grey) << table.name;
  EXPECT_LE(outside.mean, bounds.outside) << table.name;
  EXPECT_NEAR(table.mean_error, usual.mean, 0.25 * usual.mean + 0.005) << "what is told is not so";
}

const std::filesystem::path kAces = std::filesystem::path(AFTERGLOW_PROJECT_FOLDER) / "assets/ocio/aces.ocio";

Exactly aces_view(const char* display, const char* view) {
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  const auto shown = OCIO::DisplayViewTransform::Create();
  shown->setSrc("Linear Rec.709 (sRGB)");
  shown->setDisplay(display);
  shown->setView(view);
  const auto cpu = OCIO::Config::CreateFromFile(kAces.c_str())
                       ->getProcessor(shown)
                       ->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
  return [cpu](float* rgb) { cpu->applyRGB(rgb); };
}

OcioRequest request_of(const char* display, const char* view) {
  OcioRequest out;
  out.config = kAces;
  out.display = display;
  out.view = view;
  return out;
}

TEST(DisplayTable, ViewsOfOpenColorIo) {
  for (const char* display : {"sRGB - Display", "Rec.1886 Rec.709 - Display", "P3-D65 - Display"})
    for (const char* view : {"ACES 1 - SDR Video", "ACES 1 - SDR Video with gamut compression", "Un-tone-mapped"}) {
      const auto shown = display_of_config(request_of(display, view));
      ASSERT_TRUE(shown) << shown.error().text();
      EXPECT_EQ(shown->table.name, std::string(display) + ", " + view);
      expect_near(shown->table, 4, aces_view(display, view),
                  std::string(display).starts_with("sRGB") ? Bounds{1, 0.05, 0.3, 0.5} : Bounds{8, 0.08, 1, 1.2});
    }
}

using Curve = std::unique_ptr<cmsToneCurve, void (*)(cmsToneCurve*)>;
Curve power(double exponent) { return {cmsBuildGamma(nullptr, exponent), cmsFreeToneCurve}; }
Curve srgb() {
  const cmsFloat64Number values[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  return {cmsBuildParametricToneCurve(nullptr, 4, values), cmsFreeToneCurve};
}
/// As calibrators write them.
Curve sampled() {
  std::array<std::uint16_t, 1024> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes[i] = static_cast<std::uint16_t>(std::lround(65535 * std::pow(static_cast<double>(i) / 1023, 2.25)));
  return {cmsBuildTabulatedToneCurve16(nullptr, codes.size(), codes.data()), cmsFreeToneCurve};
}

cmsHPROFILE rgb_profile(const std::array<double, 6>& xy, cmsToneCurve* curve) {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries{{xy[0], xy[1], 1}, {xy[2], xy[3], 1}, {xy[4], xy[5], 1}};
  cmsToneCurve* curves[] = {curve, curve, curve};
  return cmsCreateRGBProfile(&white, &primaries, curves);
}

constexpr std::array<double, 6> kRec709{0.64, 0.33, 0.30, 0.60, 0.15, 0.06}, kP3{0.68, 0.32, 0.265, 0.69, 0.15, 0.06};

struct Monitor {
  std::string name;
  cmsHPROFILE profile;
};

/// Its colours by Little CMS, as a viewer would ask for them.
Exactly monitor_colors(cmsHPROFILE profile) {
  const Curve linear = power(1);
  const cmsHPROFILE source = rgb_profile(kRec709, linear.get());
  const std::shared_ptr<void> transform(
      cmsCreateTransform(source, TYPE_RGB_FLT, profile, TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC,
                         cmsFLAGS_NOCACHE | cmsFLAGS_BLACKPOINTCOMPENSATION),
      cmsDeleteTransform);
  cmsCloseProfile(source);
  return [transform](float* rgb) { cmsDoTransform(transform.get(), rgb, rgb, 1); };
}

class DisplayProfiles : public testing::Test {
 protected:
  std::filesystem::path save(cmsHPROFILE profile, const std::string& name) {
    const auto file = folder_ / name;
    EXPECT_TRUE(cmsSaveProfileToFile(profile, file.c_str()));
    return file;
  }
  std::filesystem::path write(const std::string& text, const std::string& name) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

TEST_F(DisplayProfiles, OfMonitors) {
  const auto curves = [] {
    std::vector<std::pair<std::string, Curve>> out;
    out.emplace_back("sRGB curve", srgb());
    out.emplace_back("2.2", power(2.2));
    out.emplace_back("2.4", power(2.4));
    out.emplace_back("samples of 2.25", sampled());
    return out;
  }();
  for (const auto& [primaries, gamut] : {std::pair(kRec709, "Rec.709"), std::pair(kP3, "P3")})
    for (const auto& [what, curve] : curves) {
      const cmsHPROFILE profile = rgb_profile(primaries, curve.get());
      auto table = icc_display_table(save(profile, "monitor.icc"));
      ASSERT_TRUE(table) << table.error().text();
      EXPECT_EQ(table->name, "RGB built-in");
      table->name = std::string(gamut) + ", " + what;
      expect_near(*table, 0, monitor_colors(profile), {what.starts_with("samples") ? 2.5 : 0.5, 0.08, 1, 1});
      cmsCloseProfile(profile);
    }
}

}  // namespace
}  // namespace afterglow
