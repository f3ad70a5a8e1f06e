// SPDX-License-Identifier: MIT
// What a picture file means to the stack, whatever its format: colour made scene-linear, auxiliary layers, windows.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hash.h"
#include "core/unset_vector.h"
#include "image/image.h"
#include "image/non_finite.h"

namespace afterglow {

/// Colours and alpha are held at ±this, where they are read and behind every pass: sums and products of a few of them
/// stay finite.
inline constexpr float kLargestColor = 1e30f;
/// Colours, depths, normals and motion below it are read as 0: devices may take denormal numbers for 0 in arithmetic,
/// but not where they only copy.
inline constexpr float kSmallestColor = std::numeric_limits<float>::min();

/// What had to be made finite before the stack (math.md §18).
struct SanitizeCounts {
  static constexpr float kNoise = 0.01f;  ///< what ringing and lossy compression take below 0
  std::uint64_t nan = 0;                  ///< NaN colour samples set to 0
  std::uint64_t negative = 0;             ///< negative colour samples set to 0, where they are not kept
  std::uint64_t far_below = 0;            ///< those of them below -kNoise
  std::uint64_t too_large = 0;            ///< colour samples above kLargestColor (or +infinity) set to it
  std::uint64_t alpha = 0;                ///< non-finite alpha samples (NaN and ±infinity) set to 1
  std::uint64_t depth = 0;                ///< non-finite depths set to 1e10
  std::uint64_t normal = 0;               ///< non-finite normals set to 0 0 0
};

struct FileFacts;  // format, pixel type, metadata, …: image/metadata.h; kept for the writer

/// One frame, ready for a stack. All images cover `data_window` and have its size.
struct Picture {
  /// RGBA; scene-linear Rec.709, alpha associated (premultiplied), finite, ≥ 0 unless ReadOptions::keep_negative.
  Image color;
  /// Auxiliary inputs by name. "depth": 1 channel, view-space distance in scene units (background 1e10), or device
  /// depth as stored; "normal": 3 channels as stored; "motion": 2 channels, how far the pixel's content moves in
  /// one frame, in pixels, x to the right and y down; "layer:NAME": up to 4 channels as stored, finite. Only those that
  /// the file (or --depth/--normal/--motion) holds and the caller asked for.
  std::map<std::string, Image> auxiliary;
  std::vector<std::string> asked;   ///< names of auxiliary inputs that it was read for: what is not there, it has not
  std::vector<std::string> layers;  ///< names of all layers of the file, read or not
  std::map<std::string, std::string> hints;  ///< of inputs that it has not: which channels may be meant
  /// Hashes of `color` ("source") and of auxiliary images, where they are known: equal hashes mean equal pixels.
  std::map<std::string, Hash> content;
  /// When not empty, the pixels of `color` as half floats, RGBA, in place of color.pixels, which are empty then: of
  /// readers that were allowed to (ReadOptions::halves). Whoever wants floats calls open_color or color_row.
  UnsetVector<std::uint16_t> halves;
  /// When not empty, `color` as 8-bit display codes that need no more encoding, RGBA: sRGB, alpha straight.
  UnsetVector<std::uint8_t> unorm8;
  /// Its light stands for codes of a display's view, by the sRGB curve: integers are those codes, and no file says that
  /// they are sRGB.
  bool view = false;
  bool has_alpha = false;  ///< the file stored alpha; without it the A of `color` is 1
  Rect data_window;        ///< where `color` lies, in the coordinates of the file, after orientation is applied
  Rect display_window;     ///< what a display format shows
  SanitizeCounts sanitized;
  /// What was not finite, by layer, before it was mended: "color", "depth", "normal", "motion" (as stored, upright).
  /// Layers without are not listed.
  std::map<std::string, NonFinite> non_finite;
  std::shared_ptr<const FileFacts> facts;  ///< never null after reading; may be null for pictures made in memory
};

/// Makes RGBA of scene-linear light finite and its colours ≥ 0, as `SanitizeCounts` says, and counts that.
void sanitize_color(float* rgba, std::size_t pixels, SanitizeCounts& counts, bool keep_negative = false);
/// Values of depth, normals, motion and the like below kSmallestColor become 0, as those of colours do.
void flush_smallest(float* values, std::size_t count);

/// Makes floats of colours that are half floats, in `memory` where that has room; leaves others as they are.
void open_color(Picture& picture, std::vector<float> memory = {});

/// Fills in `content`. Whoever changes pixels afterwards has to clear it.
void note_content(Picture& picture);

}  // namespace afterglow
