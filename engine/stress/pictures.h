// SPDX-License-Identifier: MIT
// Pictures that are hard to stand. Each is made from its kind, size and seed alone, the same on every machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/picture.h"
#include "stress/random.h"

namespace afterglow::stress {

struct PictureSpec {
  std::string kind;
  Size size;
  std::uint64_t seed = 0;
};

struct PictureKind {
  const char* name;
  const char* doc;
  void (*fill)(Image& rgba, Random& random);
  /// Finite and at most 1e6; exact in half floats where they reach so far. What effects promise is meant for these.
  bool gentle;
};

std::span<const PictureKind> picture_kinds();
/// Null when there is none of that name.
const PictureKind* find_picture_kind(const std::string& name);

/// RGBA and all auxiliary inputs ("depth", "normal", "motion"). Kinds that are not gentle may hold NaN, infinities and
/// negative values: what a broken renderer writes. The kind must exist.
Picture make_picture(const PictureSpec& spec);

/// The picture as a stack gets it: written to an EXR file in `folder` and read again, which makes it finite. Errors:
/// io.
Result<Picture> as_read(const Picture& picture, const std::filesystem::path& folder, Diagnostics& diagnostics);

/// Every value of the colour to the nearest half float within ±65504.
void round_to_halves(Image& rgba);

/// A part that lies within the image.
Image cropped(const Image& image, const Rect& part);

}  // namespace afterglow::stress
