// SPDX-License-Identifier: MIT
#include "play/packed_picture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "core/half.h"
#include "core/parallel.h"
#include "core/release_memory.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr std::size_t kBlock =
    8192;  ///< values that are looked at before the next: most pictures show early what they are

const std::vector<float>& code_lights() {
  static const std::vector<float> lights = srgb_decode_table(255);
  return lights;
}

/// Calls `work(begin, end)` for parts of so many values, on several threads.
template <class Work>
void in_parts(std::size_t values, const Work& work) {
  const auto blocks = static_cast<int>((values + kBlock - 1) / kBlock);
  parallel_rows(blocks, static_cast<long long>(values), [&](int from, int to) {
    work(static_cast<std::size_t>(from) * kBlock, std::min(static_cast<std::size_t>(to) * kBlock, values));
  });
}

}  // namespace

PackedPixels::PackedPixels(Image& image) : values_(image.pixels.size()) {
  if (image.channels == 4 && take_codes(image.pixels)) {
    form_ = Form::codes;
  } else if (take_halves(image.pixels)) {
    form_ = Form::halves;
  } else {
    floats_ = std::move(image.pixels);
  }
  release_memory(image.pixels);
}

bool PackedPixels::take_halves(const std::vector<float>& pixels) {
  std::vector<float> back(kBlock);
  for (std::size_t at = 0; at < values_; at += kBlock) {
    const std::size_t count = std::min(kBlock, values_ - at);
    if (at == kBlock) halves_.reserve(values_);  // the first block says whether it is worth the memory
    halves_.resize(at + count);
    halves_from_floats(&pixels[at], count, &halves_[at]);
    floats_from_halves(&halves_[at], count, back.data());
    if (std::memcmp(back.data(), &pixels[at], count * sizeof(float)) != 0) {
      release_memory(halves_);
      return false;
    }
  }
  return values_ > 0;
}

bool PackedPixels::take_codes(const std::vector<float>& pixels) {
  const CodeEncoder& encoder = CodeEncoder::srgb(255);
  const std::vector<float>& lights = code_lights();
  const auto opaque = std::bit_cast<std::uint32_t>(1.0f);
  for (std::size_t at = 0; at < values_; at += kBlock) {
    const std::size_t end = std::min(at + kBlock, values_);
    if (at == kBlock) codes_.reserve(values_ / 4 * 3);
    codes_.resize(end / 4 * 3);
    std::uint8_t* code = &codes_[at / 4 * 3];
    std::uint32_t different = 0;
    for (std::size_t i = at; i < end; i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        *code = static_cast<std::uint8_t>(encoder(pixels[i + c]));
        different |= std::bit_cast<std::uint32_t>(lights[*code++]) ^ std::bit_cast<std::uint32_t>(pixels[i + c]);
      }
      different |= std::bit_cast<std::uint32_t>(pixels[i + 3]) ^ opaque;
    }
    if (different != 0) {
      release_memory(codes_);
      return false;
    }
  }
  return values_ > 0;
}

void PackedPixels::open(std::vector<float>& into) const {
  into.resize(values_);
  switch (form_) {
    case Form::floats:
      std::ranges::copy(floats_, into.begin());
      break;
    case Form::halves:
      in_parts(values_,
               [&](std::size_t from, std::size_t to) { floats_from_halves(&halves_[from], to - from, &into[from]); });
      break;
    case Form::codes:
      in_parts(values_, [&, &lights = code_lights()](std::size_t from, std::size_t to) {
        const std::uint8_t* code = &codes_[from / 4 * 3];
        for (std::size_t i = from; i < to; i += 4, code += 3) {
          into[i] = lights[code[0]];
          into[i + 1] = lights[code[1]];
          into[i + 2] = lights[code[2]];
          into[i + 3] = 1;
        }
      });
      break;
  }
}

std::uint64_t PackedPixels::bytes() const {
  return floats_.size() * sizeof(float) + halves_.size() * sizeof(std::uint16_t) + codes_.size();
}

PackedPicture::PackedPicture(Picture picture) : rest_(std::move(picture)), color_(rest_.color) {
  if (!smaller()) return;
  for (auto& [name, image] : rest_.auxiliary) auxiliary_.emplace(name, PackedPixels(image));
}

Picture PackedPicture::open(std::vector<float> memory) const {
  Picture out = rest_;
  out.color.pixels = std::move(memory);
  color_.open(out.color.pixels);
  for (const auto& [name, pixels] : auxiliary_) pixels.open(out.auxiliary.at(name).pixels);
  return out;
}

Picture PackedPicture::whole() && {
  if (smaller()) return open();
  rest_.color.pixels = color_.floats();
  return std::move(rest_);
}

std::uint64_t PackedPicture::bytes() const {
  std::uint64_t bytes = color_.bytes() + rest_.unorm8.size();
  for (const auto& [name, image] : rest_.auxiliary) bytes += image.bytes();
  for (const auto& [name, pixels] : auxiliary_) bytes += pixels.bytes();
  return bytes;
}

}  // namespace afterglow
