// SPDX-License-Identifier: MIT
#include "image/exr_dwa.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHuf.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace afterglow {
namespace {

constexpr std::size_t kHufRoom = 65536;  // hufCompress() asks for these bytes beside two a value
constexpr int kLongestRun = 128, kMostSingle = 127, kWorthARun = 3;

/// Numbers at the beginning of a chunk; those that are not here are 0.
enum Place { version, ac_bytes = 3, dc_bytes, rle_bytes, rle_runs, rle_raw, ac_values, dc_values, numbers = 11 };
constexpr std::uint64_t kVersion = 2;

/// How a channel of this name is packed, as the chunk says it: 0x04 by cosines, the number of its colour above; 0x08 by
/// runs. Then the type: half floats.
struct Rule {
  char name;
  std::uint8_t how;
};
constexpr Rule kRules[] = {{'R', 0x14}, {'G', 0x24}, {'B', 0x34}, {'A', 0x08}};
constexpr std::uint8_t kHalf = 1;

void put_number(std::vector<std::uint8_t>& packed, Place place, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i)
    packed[static_cast<std::size_t>(place) * 8 + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void put_rules(std::vector<std::uint8_t>& packed, bool has_alpha) {
  const std::size_t rules = has_alpha ? 4 : 3, bytes = 2 + 4 * rules;
  packed.push_back(static_cast<std::uint8_t>(bytes));
  packed.push_back(0);
  for (std::size_t i = 0; i < rules; ++i)
    packed.insert(packed.end(), {static_cast<std::uint8_t>(kRules[i].name), 0, kRules[i].how, kHalf});
}

/// A number from 0 on: one more than that of the byte behind it. One below 0: that many bytes as they are.
void put_runs(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  const int size = static_cast<int>(bytes.size());
  const auto run_at = [&](int i) {
    int run = 1;
    while (i + run < size && run < kLongestRun &&
           bytes[static_cast<std::size_t>(i + run)] == bytes[static_cast<std::size_t>(i)])
      ++run;
    return run;
  };
  for (int i = 0; i < size;) {
    if (const int run = run_at(i); run >= kWorthARun) {
      out.push_back(static_cast<std::uint8_t>(run - 1));
      out.push_back(bytes[static_cast<std::size_t>(i)]);
      i += run;
      continue;
    }
    const int first = i;
    while (i < size && i - first < kMostSingle && run_at(i) < kWorthARun) ++i;
    out.push_back(static_cast<std::uint8_t>(first - i));
    out.insert(out.end(), bytes.begin() + first, bytes.begin() + i);
  }
}

/// Beyond the end pixels come again, backwards.
int mirrored(int at, int size) { return at < size ? at : std::max(2 * size - 1 - at, 0); }

std::uint16_t half_at(const std::uint8_t* line, int x) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, line + 2 * static_cast<std::ptrdiff_t>(x), sizeof bits);
  return bits;
}

std::span<const std::uint8_t> as_bytes(std::span<const std::uint16_t> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

}  // namespace

bool has_dwa_lines(const Imf::Header& header) {
  if (header.compression() != Imf::DWAA_COMPRESSION && header.compression() != Imf::DWAB_COMPRESSION) return false;
  const Imf::ChannelList& channels = header.channels();
  std::string names;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().type != Imf::HALF) return false;
    names += it.name();
  }
  return names == "BGR" || names == "ABGR";
}

ExrDwa::ExrDwa(const Imf::Header& header)
    : width_(header.dataWindow().max.x - header.dataWindow().min.x + 1),
      has_alpha_(header.channels().findChannel("A") != nullptr),
      dct_(header.dwaCompressionLevel()),
      zip_(header.zipCompressionLevel()) {}

std::span<const std::uint8_t> ExrDwa::run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  const std::size_t channels = has_alpha_ ? 4 : 3;
  const int lines = static_cast<int>(bytes.size() / (static_cast<std::size_t>(width_) * 2 * channels));
  pack_colour(bytes, lines);

  packed.assign(numbers * 8, 0);
  put_number(packed, version, kVersion);
  put_rules(packed, has_alpha_);

  put_number(packed, ac_values, ac_count_);
  const std::size_t ac_at = packed.size();
  packed.resize(ac_at + 2 * ac_count_ + kHufRoom);
  const int ac_size =
      Imf::hufCompress(ac_.data(), static_cast<int>(ac_count_), reinterpret_cast<char*>(packed.data() + ac_at));
  packed.resize(ac_at + static_cast<std::size_t>(ac_size));
  put_number(packed, ac_bytes, static_cast<std::uint64_t>(ac_size));

  put_number(packed, dc_values, dc_.size());
  const std::size_t dc_at = packed.size();
  zip_.append(as_bytes(dc_), packed);
  put_number(packed, dc_bytes, packed.size() - dc_at);

  if (has_alpha_) {
    pack_alpha(bytes, lines);
    put_number(packed, rle_raw, alpha_.size());
    put_number(packed, rle_runs, runs_.size());
    const std::size_t runs_at = packed.size();
    zip_.append_plain(runs_, packed);
    put_number(packed, rle_bytes, packed.size() - runs_at);
  }
  if (packed.size() >= bytes.size()) return bytes;
  return packed;
}

void ExrDwa::pack_colour(std::span<const std::uint8_t> bytes, int lines) {
  const int across = (width_ + kDctSide - 1) / kDctSide, down = (lines + kDctSide - 1) / kDctSide;
  const auto blocks = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  const std::size_t channel = static_cast<std::size_t>(width_) * 2, line = channel * (has_alpha_ ? 4 : 3);
  ac_.resize(blocks * 3 * (kDctSize - 1));
  dc_.resize(blocks * 3);
  const float* curve = dwa_curve();
  std::uint16_t* ac = ac_.data();
  DctBlock block;
  std::array<std::uint16_t, 3> dc;
  for (std::size_t number = 0; number < blocks; ++number) {
    const int left = static_cast<int>(number) % across * kDctSide, top = static_cast<int>(number) / across * kDctSide;
    for (std::size_t c = 0; c < 3; ++c)
      for (int y = 0; y < kDctSide; ++y) {
        // Lines hold the channels in the order of their names: A, B, G, R.
        const std::uint8_t* from = bytes.data() + line * static_cast<std::size_t>(mirrored(top + y, lines)) +
                                   channel * (2 - c + (has_alpha_ ? 1 : 0));
        float* to = &block[c][static_cast<std::size_t>(y) * kDctSide];
        if (left + kDctSide <= width_) {
          for (int x = 0; x < kDctSide; ++x) to[x] = curve[half_at(from, left + x)];
        } else {
          for (int x = 0; x < kDctSide; ++x) to[x] = curve[half_at(from, mirrored(left + x, width_))];
        }
      }
    ac = dct_.run(block, ac, dc);
    for (std::size_t c = 0; c < 3; ++c) dc_[c * blocks + number] = dc[c];
  }
  ac_count_ = static_cast<std::size_t>(ac - ac_.data());
}

/// The lower bytes of all pixels, then the upper ones.
void ExrDwa::pack_alpha(std::span<const std::uint8_t> bytes, int lines) {
  const auto width = static_cast<std::size_t>(width_), pixels = width * static_cast<std::size_t>(lines);
  alpha_.resize(2 * pixels);
  for (std::size_t y = 0; y < static_cast<std::size_t>(lines); ++y) {
    const std::uint8_t* from = bytes.data() + y * width * 8;
    for (std::size_t x = 0; x < width; ++x) {
      alpha_[y * width + x] = from[2 * x];
      alpha_[pixels + y * width + x] = from[2 * x + 1];
    }
  }
  runs_.clear();
  put_runs(alpha_, runs_);
}

}  // namespace afterglow
