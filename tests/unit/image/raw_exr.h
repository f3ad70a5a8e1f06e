// SPDX-License-Identifier: MIT
// EXR headers byte by byte: what no library writes. No pixels follow.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "image/exr_header.h"

namespace afterglow {

class RawExr {
 public:
  /// Data and display window; corners as the file holds them.
  RawExr& windows(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    const std::string box = number(x0) + number(y0) + number(x1) + number(y1);
    return attribute("dataWindow", "box2i", box).attribute("displayWindow", "box2i", box);
  }
  RawExr& channels(int count, ExrChannelType type) {
    std::string list;
    for (int i = 0; i < count; ++i)
      list +=
          "c" + std::to_string(i) + '\0' + number(static_cast<std::int32_t>(type)) + number(0) + number(1) + number(1);
    has_channels_ = true;
    return attribute("channels", "chlist", list + '\0');
  }
  RawExr& compression(char kind) {
    has_compression_ = true;
    return attribute("compression", "compression", std::string(1, kind));
  }
  RawExr& tiles(std::int32_t width, std::int32_t height) {
    return attribute("tiles", "tiledesc", number(width) + number(height) + '\0');
  }
  RawExr& name(const std::string& part, const std::string& type) {
    return attribute("name", "string", part)
        .attribute("type", "string", type)
        .attribute("chunkCount", "int", number(1));
  }
  RawExr& attribute(const std::string& key, const std::string& type, const std::string& value) {
    text_ += key + '\0' + type + '\0' + number(static_cast<std::int32_t>(value.size())) + value;
    return *this;
  }

  std::string single(bool tiled) const { return number(20000630) + number(2 | (tiled ? 0x200 : 0)) + header() + '\0'; }
  static std::string multi(const std::vector<RawExr>& parts) {
    std::string out = number(20000630) + number(2 | 0x1000);
    for (const RawExr& part : parts) out += part.header() + '\0';
    return out + '\0';
  }

 private:
  static std::string number(std::int32_t value) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  }
  std::string header() const {
    RawExr whole = *this;
    if (!has_channels_) whole.channels(3, ExrChannelType::half);
    if (!has_compression_) whole.compression(3);
    whole.attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    whole.attribute("pixelAspectRatio", "float", number(0x3f800000));
    whole.attribute("screenWindowCenter", "v2f", number(0) + number(0));
    whole.attribute("screenWindowWidth", "float", number(0x3f800000));
    return whole.text_;
  }
  std::string text_;
  bool has_channels_ = false, has_compression_ = false;
};

}  // namespace afterglow
