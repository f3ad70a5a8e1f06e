// SPDX-License-Identifier: MIT
// A picture in less memory, where nothing of it is lost: what was read from half floats as half floats, what was read
// from 8-bit sRGB codes as codes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "image/picture.h"

namespace afterglow {

/// Pixels of an image.
class PackedPixels {
 public:
  enum class Form { floats, halves, codes };
  PackedPixels() = default;
  /// Takes the image's pixels; in the smallest form that gives back the same bits. Codes are of opaque RGBA.
  explicit PackedPixels(Image& image);
  /// `into` gets the size that it takes.
  void open(std::vector<float>& into) const;
  std::vector<float> floats() { return std::move(floats_); }  ///< of that form, without a copy
  Form form() const { return form_; }
  std::uint64_t bytes() const;

 private:
  bool take_halves(const std::vector<float>& pixels);
  bool take_codes(const std::vector<float>& pixels);

  Form form_ = Form::floats;
  std::size_t values_ = 0;
  std::vector<float> floats_;
  std::vector<std::uint16_t> halves_;
  std::vector<std::uint8_t> codes_;  ///< RGB
};

/// Immutable once made; thread-safe.
class PackedPicture {
 public:
  PackedPicture() = default;
  explicit PackedPicture(Picture picture);
  /// The picture as it was, bit for bit. `memory` becomes that of its colours.
  Picture open(std::vector<float> memory = {}) const;
  /// The picture without a copy, where it is not smaller.
  Picture whole() &&;
  /// Whether its colours take less memory than they did.
  bool smaller() const { return color_.form() != PackedPixels::Form::floats; }
  std::uint64_t bytes() const;

 private:
  Picture rest_;  ///< the images that are packed have a size and no pixels
  PackedPixels color_;
  std::map<std::string, PackedPixels> auxiliary_;
};

}  // namespace afterglow
