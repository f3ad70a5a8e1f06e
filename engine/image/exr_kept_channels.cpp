// SPDX-License-Identifier: MIT
#include "image/exr_kept_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/half.h"
#include "image/exr_line_writer.h"
#include "image/layers.h"
#include "image/read_plan.h"

namespace afterglow {
namespace {

std::array<std::uint8_t, 4> bytes_of(Imf::PixelType type, float value) {
  std::array<std::uint8_t, 4> bytes{};
  if (type == Imf::HALF) {
    const std::uint16_t half = half_from_float(std::min(value, kMaxHalf));
    std::memcpy(bytes.data(), &half, sizeof half);
  } else if (type == Imf::FLOAT) {
    std::memcpy(bytes.data(), &value, sizeof value);
  }
  return bytes;
}

std::string_view last_of(const std::string& name) {
  return std::string_view(name).substr(name.rfind('.') + 1);  // npos + 1 is 0
}

/// As OpenEXR packs: PXR24 cuts floats to 24 bits, B44 is for half floats, DWA goes by the end of the name.
bool changes(std::string_view compression, const std::string& name, Imf::PixelType type) {
  constexpr std::array<std::string_view, 6> kByCosines{"R", "G", "B", "Y", "RY", "BY"};
  if (compression == "pxr24") return type == Imf::FLOAT;
  if (compression.starts_with("b44")) return type == Imf::HALF;
  return compression.starts_with("dwa") && type != Imf::UINT &&
         std::ranges::find(kByCosines, last_of(name)) != kByCosines.end();
}

}  // namespace

ExrKeptChannels::ExrKeptChannels(const Imf::Header& header, const std::vector<std::string>& replaced,
                                 const Imath::Box2i& window)
    : own_(header.dataWindow()), window_(window) {
  FilePart part;
  if (header.hasName()) part.name = header.name();
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) part.channels.emplace_back(it.name());
  const std::vector<std::string> depths = depth_channels(part);
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (std::ranges::find(replaced, it.name()) != replaced.end()) continue;
    const bool depth = std::ranges::find(depths, it.name()) != depths.end();
    channels_.push_back({it.name(), it.channel(), bytes_of(it.channel().type, depth ? kDepth.background : 0.0F), {}});
  }
}

Result<void> ExrKeptChannels::check() const {
  for (const Kept& kept : channels_)
    if (kept.channel.xSampling != 1 || kept.channel.ySampling != 1)
      return Error{ErrorKind::io, fmt::format("cannot keep the sub-sampled channel '{}'", kept.name)};
  if (!window_.intersects(own_.min) || !window_.intersects(own_.max))
    return Error{ErrorKind::io, "cannot keep layers: they reach beyond the picture"};
  return {};
}

std::vector<std::string> ExrKeptChannels::changed_by(std::string_view compression) const {
  std::vector<std::string> names;
  for (const Kept& kept : channels_) {
    if (!changes(compression, kept.name, kept.channel.type)) continue;
    const std::size_t dot = kept.name.rfind('.');
    const std::string layer = kept.name.substr(0, dot);  // all of it without a dot
    if (std::ranges::find(names, layer) == names.end()) names.push_back(layer);
  }
  return names;
}

void ExrKeptChannels::add_channels(Imf::Header& header) const {
  for (const Kept& kept : channels_) header.channels().insert(kept.name, kept.channel);
}

void ExrKeptChannels::read(Imf::InputPart& part, int y, int rows) {
  first_ = y;
  rows_ = rows;
  for (Kept& kept : channels_) {
    const std::size_t sample = kept.sample_bytes(), count = width() * static_cast<std::size_t>(rows);
    kept.samples.resize(count * sample);
    if (own_ == window_) continue;
    for (std::size_t i = 0; i < count; ++i) std::memcpy(kept.samples.data() + i * sample, kept.nothing.data(), sample);
  }
  const int begin = std::max(y, own_.min.y), last = std::min(y + rows - 1, own_.max.y);
  if (begin > last || empty()) return;
  Imf::FrameBuffer buffer;
  add_slices(buffer);
  part.setFrameBuffer(buffer);
  part.readPixels(begin, last);
}

void ExrKeptChannels::add_slices(Imf::FrameBuffer& buffer) {
  for (Kept& kept : channels_)
    buffer.insert(kept.name, Imf::Slice::Make(kept.channel.type, kept.samples.data(), Imath::V2i(window_.min.x, first_),
                                              static_cast<int64_t>(width()), rows_, kept.sample_bytes(),
                                              kept.sample_bytes() * width()));
}

void ExrKeptChannels::put_row(const Imf::Header& header, int row, std::uint8_t* line) const {
  for (const Kept& kept : channels_) {
    const std::size_t bytes = width() * kept.sample_bytes();
    std::memcpy(line + channel_place(header, kept.name), kept.samples.data() + bytes * static_cast<std::size_t>(row),
                bytes);
  }
}

}  // namespace afterglow
