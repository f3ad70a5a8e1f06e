// SPDX-License-Identifier: MIT
// Previews: a picture that runs smaller, with its lengths scaled, shows what the whole result shows when it is scaled.
#include <cmath>

#include "harness.h"
#include "reference/resample.h"

namespace afterglow {
namespace {

using namespace reference;

constexpr Size kWhole{960, 540}, kPreview{320, 180};

/// Mean of blocks of 3×3 pixels.
DoubleImage third(const DoubleImage& image) {
  DoubleImage out(image.size().width / 3, image.size().height / 3);
  for (int y = 0; y < out.size().height; ++y)
    for (int x = 0; x < out.size().width; ++x) {
      Rgba sum(0);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) sum += image.at(3 * x + i, 3 * y + j) / 9.0;
      out.at(x, y) = sum;
    }
  return out;
}

/// Depth and normals: the pixel in the middle, as `run --size` takes it.
DoubleImage middle(const DoubleImage& image) {
  DoubleImage out(image.size().width / 3, image.size().height / 3);
  for (int y = 0; y < out.size().height; ++y)
    for (int x = 0; x < out.size().width; ++x) out.at(x, y) = image.at(3 * x + 1, 3 * y + 1);
  return out;
}

double rms(const DoubleImage& a, const DoubleImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = glm::clamp(a.pixels[i][c], 0.0, 1.0) - glm::clamp(b.pixels[i][c], 0.0, 1.0);
      sum += d * d;
    }
  return std::sqrt(sum / (3.0 * double(a.pixels.size())));
}

struct Preview : Effects {
  Scene whole = neon_scene(kWhole, 0, 0), small = whole;
  Preview() {
    small.source = in_floats(third(whole.source));
    if (small.depth) small.depth = middle(*small.depth);
    if (small.normal) small.normal = middle(*small.normal);
  }
  double difference(const std::string& entry) const {
    const std::string entries = entry + " fx.tone_mapping { mode = \"neutral\", exposure = 1 }";
    const Made full = run_stack(entries, whole, Way::fused);
    const Made preview = run_stack(entries, small, Way::fused, 1.0 / 3);
    return rms(third(from_floats(full.result.data(), full.size, 4)),
               from_floats(preview.result.data(), preview.size, 4));
  }
};

TEST_F(Preview, ShowTheWholeLook) {
  const double alone = difference("");
  for (const char* entry : {"fx.bloom { intensity = 0.5 },",
                            "fx.bloom { mode = \"scattering\", threshold = 0.5, intensity = 0.4 },",
                            "fx.box_bloom { threshold = 1.5 },",
                            "fx.anamorphic_streaks {},",
                            "fx.lens_dirt { intensity = 0.3 },",
                            "fx.dual_kawase { iterations = 4 },",
                            "fx.bokeh_blur { radius = 9 },",
                            "fx.directional_blur { distance = 30 },",
                            "fx.radial_blur {},",
                            "fx.depth_of_field { focus_distance = 6, aperture = 1.4 },",
                            "fx.chromatic_aberration {},",
                            "fx.vignette {},",
                            "fx.fxaa {},",
                            "fx.sharpen {},",
                            "fx.pixelate { size = 16 },",
                            "fx.color_adjustments { contrast = 20 },",
                            "fx.glare {},",
                            "fx.halation {},",
                            "fx.lens_flare {},",
                            "fx.depth_fog {},",
                            "fx.ssao {},",
                            "fx.crt {},",
                            "fx.letterbox {},",
                            "fx.smaa {},",
                            "fx.posterize {},",
                            "fx.curves { shadows = -0.3, highlights = 0.8 },",
                            "fx.cdl { slope = { 1.2, 1, 0.9 } },"})
    EXPECT_LE(difference(entry), 1.2 * alone) << entry << " " << alone;
  // Reads between coarse pixels are softer, and which lines there are is decided from fewer pixels.
  for (const char* entry : {"fx.lens_distortion { intensity = 0.3 },", "fx.edge_detection {},",
                            "fx.outline { width = 2, depth_scale = 4, contrast = 5 },"})
    EXPECT_LE(difference(entry), 2.2 * alone) << entry << " " << alone;
}

TEST_F(Preview, OfPyramidsWithoutScaledLengthsWouldNot) {
  // That the bound can be missed: the same preview with lengths of its own.
  const std::string entries = "fx.dual_kawase { iterations = 4 }, fx.tone_mapping { mode = \"neutral\", exposure = 1 }";
  const Made full = run_stack(entries, whole, Way::fused), preview = run_stack(entries, small, Way::fused);
  EXPECT_GT(
      rms(third(from_floats(full.result.data(), full.size, 4)), from_floats(preview.result.data(), preview.size, 4)),
      1.2 * difference(""));
}

}  // namespace
}  // namespace afterglow
