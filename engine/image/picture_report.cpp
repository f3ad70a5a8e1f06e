// SPDX-License-Identifier: MIT
#include "image/picture_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/text.h"
#include "image/metadata.h"
#include "image/orientation.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// Colours that the file or the way to Rec.709 made negative. A few are noise; primaries of older television are too
/// near for a word.
void report_gamut(const Picture& picture, const ColorEncoding& encoding, const fs::path& file,
                  Diagnostics& diagnostics) {
  constexpr std::uint64_t kFew = 1000;  // one in so many pixels
  constexpr double kNear = 0.1;
  const bool wide = encoding.transform || (encoding.matrix && !nearly_equal(*encoding.matrix, kIdentity, kNear));
  const auto many = [&](std::uint64_t count) {
    return count * kFew > static_cast<std::uint64_t>(picture.color.size().area());
  };
  const SanitizeCounts& counts = picture.sanitized;
  if (wide && many(counts.negative)) {
    diagnostics.warn_once(
        "outside Rec.709",
        fmt::format("{}: {} samples are of colours outside Rec.709; they end at 0; --gamut keep leaves them below it",
                    file.string(), counts.negative));
  } else if (encoding.curve == TransferCurve::linear && many(counts.far_below) && picture.non_finite.empty()) {
    // Codes of videos lie outside of their RGB here and there. What is not finite too stands in what `report` says.
    diagnostics.warn_once("below 0", fmt::format("{}: {} samples are below {}; light is not negative, they count as 0",
                                                 file.string(), counts.far_below, -SanitizeCounts::kNoise));
  }
}

/// Effects count in pixels: a round blur of pixels that are not square is an ellipse when they are shown.
void report_pixel_shape(const FileFacts& facts, const fs::path& file, Diagnostics& diagnostics) {
  constexpr float kNear = 0.01f;
  const MetadataValue* found = find_metadata(facts.metadata, "PixelAspectRatio");
  const float ratio = found ? metadata_number(*found, 1) : 1;
  if (!std::isfinite(ratio) || ratio <= 0 || std::abs(ratio - 1) <= kNear) return;
  const float wide = swaps_axes(facts.orientation) ? 1 / ratio : ratio;
  diagnostics.warn_once("pixels not square",
                        fmt::format("{}: its pixels are {:.3g} times as wide as high; effects take them for square: "
                                    "what they make round is not round when the picture is shown",
                                    file.string(), wide));
}

/// Centres and heights of effects go by all that was read.
void report_overscan(const Picture& picture, const fs::path& file, Diagnostics& diagnostics) {
  constexpr int kFew = 100;  // of a side one part in so many: what renderers read beside the picture for their filters
  const Rect &data = picture.data_window, &display = picture.display_window;
  const std::int64_t left = std::int64_t{display.x} - data.x, top = std::int64_t{display.y} - data.y;
  const std::int64_t x = std::max(left, data.width - left - display.width);
  const std::int64_t y = std::max(top, data.height - top - display.height);
  if (x * kFew <= display.width && y * kFew <= display.height) return;
  diagnostics.warn_once("overscan",
                        fmt::format("{}: the overscan around its {}×{} pixels counts as part of the picture, for "
                                    "centres and heights too; --overscan cut leaves it out",
                                    file.string(), display.width, display.height));
}

void report_mended(const Picture& picture, NanPolicy policy, const fs::path& file, Diagnostics& diagnostics) {
  const SanitizeCounts& counts = picture.sanitized;
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count) parts.push_back(fmt::format("{} {}", count, what));
  };
  add(counts.nan, "NaN");
  add(counts.too_large, "infinite or above 1e30");
  add(counts.alpha, "alpha");
  add(counts.depth, "depth");
  add(counts.normal, "normal");
  const bool harmless = parts.empty() && picture.non_finite.empty();  // negatives alone: ringing, lossy compression
  add(counts.negative, "negative");
  std::vector<std::string> said;
  if (!parts.empty()) said.push_back("samples made finite and not negative: " + join(parts));
  if (!picture.non_finite.empty())
    said.push_back(
        (policy == NanPolicy::neighbour ? "not finite, replaced by the mean of neighbours: " : "not finite: ") +
        non_finite_text(picture));
  if (said.empty()) return;
  const std::string text = fmt::format("{}: {}", file.string(), join(said, "; "));
  // Told once: those who run sequences sum up at the end.
  harmless ? diagnostics.note(text) : diagnostics.warn_once("values made finite", text);
}

}  // namespace

std::string non_finite_text(const Picture& picture) {
  std::vector<std::string> parts;
  for (const auto& [layer, found] : picture.non_finite)
    parts.push_back(fmt::format("{}: {}, first at {}", layer, found.text(), found.first->text()));
  return join(parts, "; ");
}

void report_shape(const Picture& picture, const fs::path& file, Diagnostics& diagnostics) {
  report_pixel_shape(*picture.facts, file, diagnostics);
  report_overscan(picture, file, diagnostics);
}

void report_values(const Picture& picture, const ColorEncoding& encoding, NanPolicy policy, const fs::path& file,
                   Diagnostics& diagnostics) {
  report_gamut(picture, encoding, file, diagnostics);
  report_mended(picture, policy, file, diagnostics);
}

}  // namespace afterglow
