// SPDX-License-Identifier: MIT
#include "image/exr_rows.h"

#include <OpenEXR/ImfChannelList.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "core/parallel.h"
#include "image/encode.h"
#include "image/exr_line_writer.h"

namespace afterglow {
namespace {

constexpr int kZipLevel = 1;

/// Every fourth sample, from the first on.
template <class Sample>
void put_channel(const Sample* rgba, std::size_t width, std::uint8_t* to) {
  for (std::size_t x = 0; x < width; ++x) std::memcpy(to + x * sizeof(Sample), rgba + 4 * x, sizeof(Sample));
}

}  // namespace

ExrColorRows::ExrColorRows(const Picture& picture, std::array<std::string, 4> names, SampleType type)
    : picture_(picture), names_(std::move(names)), type_(type) {}

void ExrColorRows::add_channels(Imf::Header& header) const {
  for (const std::string& name : names_)
    if (!name.empty()) header.channels().insert(name, Imf::Channel(type_ == SampleType::half ? Imf::HALF : Imf::FLOAT));
}

void ExrColorRows::add_slices(int first, int rows, Imf::FrameBuffer& buffer) {
  const Image& color = picture_.color;
  const Imath::V2i origin(picture_.data_window.x, picture_.data_window.y + first);
  const bool half = type_ == SampleType::half;
  const std::size_t row_samples = static_cast<std::size_t>(color.width) * 4;
  const std::size_t samples = row_samples * static_cast<std::size_t>(rows);
  const auto place = [&](int row) { return row_samples * static_cast<std::size_t>(row); };
  const std::uint16_t* halves = picture_.halves.empty() ? nullptr : half_row(picture_, first);
  const float* floats = halves ? nullptr : color.at(0, first);
  if (half && !halves) {
    halves_.resize(samples);
    parallel_rows(rows, static_cast<long long>(samples), [&](int begin, int end) {
      overflows_ += to_half(floats + place(begin), halves_.data() + place(begin), place(end - begin));
    });
    halves = halves_.data();
  } else if (!half && halves) {
    floats_.resize(samples);
    floats_from_halves(halves, samples, floats_.data());
    floats = floats_.data();
  }
  const std::size_t sample = half ? sizeof(std::uint16_t) : sizeof(float);
  for (std::size_t c = 0; c < 4; ++c) {
    if (names_[c].empty()) continue;
    const void* base = half ? static_cast<const void*>(halves + c) : static_cast<const void*>(floats + c);
    buffer.insert(names_[c], Imf::Slice::Make(half ? Imf::HALF : Imf::FLOAT, base, origin, color.width, rows,
                                              4 * sample, row_samples * sample));
  }
}

void ExrColorRows::find_places(const Imf::Header& header) {
  for (std::size_t c = 0; c < 4; ++c)
    if (!names_[c].empty()) places_[c] = channel_place(header, names_[c]);
}

void ExrColorRows::put_row(int row, std::uint8_t* line) {
  const auto width = static_cast<std::size_t>(picture_.color.width);
  const auto put = [&](const auto* rgba) {
    for (std::size_t c = 0; c < 4; ++c)
      if (!names_[c].empty()) put_channel(rgba + c, width, line + places_[c]);
  };
  thread_local std::vector<float> floats;
  thread_local std::vector<std::uint16_t> halves;
  if (type_ != SampleType::half) return put(color_row(picture_, row, floats));
  if (!picture_.halves.empty()) return put(half_row(picture_, row));
  halves.resize(width * 4);
  overflows_ += to_half(picture_.color.at(0, row), halves.data(), width * 4);
  put(halves.data());
}

void ExrColorRows::warn_of_overflow(const Imf::Header& header, Diagnostics& diagnostics) const {
  std::uint64_t held = overflows_;
  const Imf::Compression compression = header.compression();
  if (type_ != SampleType::half && picture_.halves.empty() &&
      (compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION))
    for (std::size_t i = 0; i < picture_.color.pixels.size(); ++i)
      held += i % 4 < 3 && std::abs(picture_.color.pixels[i]) > kMaxHalf;
  if (held) diagnostics.warn(fmt::format("{} samples beyond the range of half floats are held at ±65504", held));
}

Imath::Box2i exr_window(const Rect& rect) {
  return {{rect.x, rect.y}, {rect.x + rect.width - 1, rect.y + rect.height - 1}};
}

Result<void> set_compression(Imf::Header& header, const std::string& text) {
  AFTERGLOW_TRY(const Compression wanted, parse_compression(text.empty() ? "zip" : text));
  constexpr std::array kNames{"none",  "rle", "zips", "zip",  "piz",
                              "pxr24", "b44", "b44a", "dwaa", "dwab"};  // in OpenEXR's numbering
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (wanted.name == kNames[i]) header.compression() = static_cast<Imf::Compression>(i);
  header.zipCompressionLevel() = kZipLevel;
  if (wanted.level < 0) return {};
  if (wanted.name == "dwaa" || wanted.name == "dwab") {
    header.dwaCompressionLevel() = wanted.level;
  } else {
    header.zipCompressionLevel() = static_cast<int>(std::min(wanted.level, 9.0f));
  }
  return {};
}

}  // namespace afterglow
