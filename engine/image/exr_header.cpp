// SPDX-License-Identifier: MIT
#include "image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

#include "core/saturated.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little, "EXR is little-endian and is read as it is");

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;
constexpr std::size_t kMaxName = 255;
constexpr std::size_t kMaxParts = 4096, kMaxAttributes = 65536, kMaxChannels = 4096;
constexpr std::int64_t kMaxCoordinate =
    1 << 29;  // half of OpenEXR's limit: differences of two, and sides, stay within an int
constexpr std::uint64_t kMaxChannelList = 4u << 20;

/// Bytes of values whose types have a size. OpenEXR reads so many of them, whatever the header claims.
struct TypeSize {
  std::string_view type;
  std::int32_t bytes;
};
constexpr std::array kTypeSizes{
    TypeSize{"box2i", 16},      TypeSize{"box2f", 16},    TypeSize{"chromaticities", 32},
    TypeSize{"compression", 1}, TypeSize{"double", 8},    TypeSize{"deepImageState", 1},
    TypeSize{"envmap", 1},      TypeSize{"float", 4},     TypeSize{"int", 4},
    TypeSize{"keycode", 28},    TypeSize{"lineOrder", 1}, TypeSize{"m33f", 36},
    TypeSize{"m33d", 72},       TypeSize{"m44f", 64},     TypeSize{"m44d", 128},
    TypeSize{"rational", 8},    TypeSize{"tiledesc", 9},  TypeSize{"timecode", 8},
    TypeSize{"v2i", 8},         TypeSize{"v2f", 8},       TypeSize{"v2d", 16},
    TypeSize{"v3i", 12},        TypeSize{"v3f", 12},      TypeSize{"v3d", 24},
};

struct Malformed {
  std::string why;
};

/// A reader of the header that never goes beyond the end of the file. Throws Malformed, within this file only.
class Bytes {
 public:
  Bytes(const fs::path& file, std::uint64_t size) : in_(file, std::ios::binary), left_(size) {}

  template <class T>
  T number() {
    T value{};
    read(&value, sizeof value);
    return value;
  }
  void read(void* into, std::uint64_t size) {
    if (size > left_ || !in_.read(static_cast<char*>(into), static_cast<std::streamsize>(size)))
      throw Malformed{"the header is truncated"};
    left_ -= size;
  }
  void skip(std::uint64_t size) {
    if (size > left_) throw Malformed{"the header is truncated"};
    in_.seekg(static_cast<std::streamoff>(size), std::ios::cur);
    left_ -= size;
  }
  std::string text() {
    std::string result;
    while (const char c = number<char>()) {
      if (result.size() >= kMaxName) throw Malformed{"a name in the header is too long"};
      result += c;
    }
    return result;
  }
  std::uint64_t left() const { return left_; }

 private:
  std::ifstream in_;
  std::uint64_t left_;
};

std::vector<ExrChannel> channel_list(const std::vector<char>& value) {
  std::vector<ExrChannel> channels;
  std::size_t at = 0;
  while (at < value.size() && value[at] != 0) {
    const auto* end = static_cast<const char*>(std::memchr(&value[at], 0, value.size() - at));
    if (channels.size() >= kMaxChannels) throw Malformed{fmt::format("has more than {} channels", kMaxChannels)};
    if (!end) throw Malformed{"the channel list is malformed"};
    ExrChannel channel;
    channel.name.assign(&value[at], end);
    at += channel.name.size() + 1;
    std::array<std::int32_t, 4> numbers{};  // type, pLinear and reserved bytes, x and y sampling
    if (value.size() - at < sizeof numbers) throw Malformed{"the channel list is malformed"};
    std::memcpy(numbers.data(), &value[at], sizeof numbers);
    at += sizeof numbers;
    if (numbers[0] < 0 || numbers[0] > 2 || numbers[2] < 1 || numbers[3] < 1)
      throw Malformed{"the channel list is malformed"};
    channel.type = static_cast<ExrChannelType>(numbers[0]);
    channel.x_sampling = numbers[2];
    channel.y_sampling = numbers[3];
    channels.push_back(std::move(channel));
  }
  // OpenEXR reads on until it finds the end of the list, be it behind the end of the attribute.
  if (at + 1 != value.size()) throw Malformed{"the channel list is malformed"};
  if (channels.empty()) throw Malformed{"has no channels"};
  return channels;
}

Rect window(const std::array<std::int32_t, 4>& box, const char* what) {
  for (const std::int64_t c : box)
    if (c < -kMaxCoordinate || c > kMaxCoordinate) throw Malformed{fmt::format("the {} window is out of range", what)};
  const std::int64_t width = std::int64_t{box[2]} - box[0] + 1, height = std::int64_t{box[3]} - box[1] + 1;
  if (width < 1 || height < 1) throw Malformed{fmt::format("the {} window is empty", what)};
  return {box[0], box[1], static_cast<int>(width), static_cast<int>(height)};
}

/// Reads a value that nobody here needs, with the same steps as OpenEXR, which must end where the attribute does: else
/// the two would see different headers from there on.
void pass_over(Bytes& bytes, const std::string& name, std::string_view type, std::int32_t size) {
  const auto require = [&](bool holds) {
    if (!holds) throw Malformed{fmt::format("attribute '{}' is malformed", name)};
  };
  auto left = static_cast<std::uint64_t>(size);
  if (type == "floatvector") {
    require(left % sizeof(float) == 0);
  } else if (type == "preview") {
    require(left >= 8);
    const auto sides = bytes.number<std::array<std::uint32_t, 2>>();
    left -= 8;
    require(saturated_product({sides[0], sides[1], 4}) == left);
  } else if (type == "stringvector") {
    while (left > 0) {
      require(left >= 4);
      const auto length = bytes.number<std::uint32_t>();
      left -= 4;
      require(length <= left);
      bytes.skip(length);
      left -= length;
    }
  } else if (type == "chlist") {
    require(false);  // no second list
  }
  bytes.skip(left);
}

/// The names of a "multiView"; those that are longer than names of channels are of none.
std::vector<std::string> read_views(Bytes& bytes, std::int32_t size) {
  constexpr std::size_t kMost = 64;
  std::vector<std::string> views;
  auto left = static_cast<std::uint64_t>(size);
  while (left > 0) {
    if (left < sizeof(std::uint32_t)) throw Malformed{"attribute 'multiView' is malformed"};
    const auto length = bytes.number<std::uint32_t>();
    left -= sizeof length;
    if (length > left) throw Malformed{"attribute 'multiView' is malformed"};
    left -= length;
    if (length > kMaxName || views.size() >= kMost) {
      bytes.skip(length);
      continue;
    }
    std::string view(length, '\0');
    bytes.read(view.data(), view.size());
    if (!view.empty()) views.push_back(std::move(view));
  }
  return views;
}

/// One part's attributes; nothing when the list is empty, which ends a multi-part header.
std::optional<ExrPart> read_part(Bytes& bytes, std::uint32_t flags) {
  ExrPart part;
  part.tiled = (flags & kTiledFlag) != 0;
  part.deep = (flags & kDeepFlag) != 0;
  std::set<std::string> names;
  while (true) {
    if (names.size() > kMaxAttributes) throw Malformed{"the header has too many attributes"};
    const std::string name = bytes.text();
    if (name.empty()) {
      if (names.empty()) return std::nullopt;
      break;
    }
    if (!names.insert(name).second) throw Malformed{fmt::format("attribute '{}' is there twice", name)};
    const std::string type = bytes.text();
    const auto size = bytes.number<std::int32_t>();
    if (size < 0 || static_cast<std::uint64_t>(size) > bytes.left())
      throw Malformed{fmt::format("attribute '{}' claims more bytes than the file has", name)};
    const auto* sized = std::ranges::find(kTypeSizes, type, &TypeSize::type);
    const auto expect = [&](const char* wanted) {
      if (type != wanted) throw Malformed{fmt::format("attribute '{}' is malformed", name)};
    };
    if (sized != kTypeSizes.end() && size != sized->bytes)
      throw Malformed{fmt::format("attribute '{}' is malformed", name)};
    if (name == "channels") {
      expect("chlist");
      if (static_cast<std::uint64_t>(size) > kMaxChannelList)
        throw Malformed{fmt::format("has more than {} channels", kMaxChannels)};
      std::vector<char> value(static_cast<std::size_t>(size));
      bytes.read(value.data(), value.size());
      part.channels = channel_list(value);
    } else if (name == "dataWindow" || name == "displayWindow") {
      expect("box2i");
      const bool data = name == "dataWindow";
      (data ? part.data_window : part.display_window) =
          window(bytes.number<std::array<std::int32_t, 4>>(), data ? "data" : "display");
    } else if (name == "compression") {
      expect("compression");
      part.compression = bytes.number<unsigned char>();
    } else if (name == "tiles") {
      expect("tiledesc");
      const auto sides = bytes.number<std::array<std::uint32_t, 2>>();
      if (sides[0] < 1 || sides[1] < 1 || sides[0] > kMaxCoordinate || sides[1] > kMaxCoordinate)
        throw Malformed{"the tile size is out of range"};
      part.tile = {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
      bytes.skip(1);
    } else if (name == "Orientation" && type == "int") {
      part.orientation = std::clamp(bytes.number<std::int32_t>(), 1, 8);
    } else if (name == "chunkCount") {
      // OpenEXR takes memory for the places of so many, where it does not know the type of the part.
      expect("int");
      const auto chunks = bytes.number<std::int32_t>();
      if (chunks < 0 || static_cast<std::uint64_t>(chunks) > bytes.left())
        throw Malformed{"the header claims more chunks than the file has"};
    } else if (name == "name" || name == "type") {
      expect("string");
      if (size > 4096) throw Malformed{fmt::format("attribute '{}' is malformed", name)};
      std::string value(static_cast<std::size_t>(size), '\0');
      bytes.read(value.data(), value.size());
      if (name == "name") {
        part.name = value;
      } else {
        part.tiled = value == "tiledimage" || value == "deeptile";
        part.deep = value == "deepscanline" || value == "deeptile";
      }
    } else if (name == "view" && type == "string" && static_cast<std::size_t>(size) <= kMaxName) {
      part.view.resize(static_cast<std::size_t>(size));
      bytes.read(part.view.data(), part.view.size());
    } else if (name == "multiView" && type == "stringvector") {
      part.views = read_views(bytes, size);
    } else {
      pass_over(bytes, name, type, size);
    }
  }
  for (const char* needed : {"channels", "dataWindow", "displayWindow"})
    if (!names.contains(needed)) throw Malformed{"the header lacks its channels or windows"};
  if (part.tiled && part.tile.width == 0) throw Malformed{"the header lacks its tile size"};
  return part;
}

}  // namespace

std::uint64_t ExrPart::pixel_bytes() const {
  std::uint64_t bytes = 0;
  for (const ExrChannel& channel : channels) bytes += channel.sample_bytes();
  return bytes;
}

int chunk_lines_of(int compression) {
  switch (compression) {
    case 3:
    case 5:
      return 16;  // zip, pxr24
    case 4:
    case 6:
    case 7:
    case 8:
      return 32;  // piz, b44, b44a, dwaa
    case 9:
      return 256;  // dwab
    default:
      return 1;
  }
}

int ExrPart::chunk_lines() const { return chunk_lines_of(compression); }

std::uint64_t ExrPart::chunks() const {
  const auto pieces = [](int side, int piece) {
    return (std::uint64_t(side) + std::uint64_t(piece) - 1) / std::uint64_t(piece);
  };
  if (tiled) return pieces(data_window.width, tile.width) * pieces(data_window.height, tile.height);
  return pieces(data_window.height, chunk_lines());
}

std::uint64_t ExrPart::least_file_bytes() const {
  const std::uint64_t places = chunks() * sizeof(std::uint64_t);
  if (deep) return places;
  std::uint64_t raw = 0;
  for (const ExrChannel& channel : channels) {
    const auto columns = static_cast<std::uint64_t>(data_window.width / channel.x_sampling);
    const auto lines = static_cast<std::uint64_t>(data_window.height / channel.y_sampling);
    raw = saturated_sum({raw, saturated_product({columns, lines, channel.sample_bytes()})});
  }
  switch (compression) {
    case 0:
      return saturated_sum({places, raw});
    case 1:
      return places + raw / 64;  // 2 bytes for a run of 128
    case 2:
    case 3:
      return places + raw / 1100;  // deflate gains 1032 at most
    case 5:
      return places + raw / 1500;  // and floats are cut to 24 bits before
    default:
      return places;
  }
}

std::uint64_t ExrPart::buffer_bytes(int threads) const {
  const std::uint64_t buffers =
      4 * static_cast<std::uint64_t>(std::max(threads, 1));  // two a thread, packed and unpacked
  const auto width = static_cast<std::uint64_t>(data_window.width);
  if (!tiled) {
    const int lines = std::min(chunk_lines(), data_window.height);
    return saturated_product({width, static_cast<std::uint64_t>(lines), pixel_bytes(), buffers});
  }
  const auto tile_width = static_cast<std::uint64_t>(tile.width), tile_height = static_cast<std::uint64_t>(tile.height);
  return saturated_sum({saturated_product({tile_width, tile_height, pixel_bytes(), buffers}),
                        saturated_product({width + tile_width, tile_height, pixel_bytes()})});
}

bool is_exr(const fs::path& file) {
  std::uint32_t magic = 0;
  std::ifstream in(file, std::ios::binary);
  return in.read(reinterpret_cast<char*>(&magic), sizeof magic) && magic == kMagic;
}

Result<std::vector<ExrPart>> read_exr_header(const fs::path& file) {
  std::error_code ec;
  const std::uint64_t size = fs::file_size(file, ec);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be read: {}", ec.message()), file.string()};
  try {
    Bytes bytes(file, size);
    if (bytes.number<std::uint32_t>() != kMagic) throw Malformed{"is not an OpenEXR file"};
    const auto version = bytes.number<std::uint32_t>();
    if ((version & 0xff) != 2)
      throw Malformed{fmt::format("is of OpenEXR file version {}, which is not known", version & 0xff)};
    std::vector<ExrPart> parts;
    if (!(version & kMultiPartFlag)) {
      auto part = read_part(bytes, version);
      if (!part) throw Malformed{"the header is empty"};
      parts.push_back(std::move(*part));
      return parts;
    }
    while (auto part = read_part(bytes, 0)) {
      parts.push_back(std::move(*part));
      if (parts.size() > kMaxParts) throw Malformed{fmt::format("has more than {} parts", kMaxParts)};
    }
    if (parts.empty()) throw Malformed{"the header is empty"};
    return parts;
  } catch (const Malformed& error) {
    return Error{ErrorKind::io, error.why, file.string()};
  }
}

}  // namespace afterglow
