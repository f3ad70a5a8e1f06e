// SPDX-License-Identifier: MIT
// EXR files of ZIP and ZIPS, whose chunks are packed here, against what OpenEXR writes and reads.
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCheckFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fcntl.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>

#include "image/exr_line_writer.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// All channels of a picture, each with its own samples as the file holds them.
struct Channels {
  Imath::Box2i window;
  std::map<std::string, std::pair<Imf::PixelType, Bytes>> channels;

  std::size_t width() const { return static_cast<std::size_t>(window.max.x - window.min.x + 1); }
  int height() const { return window.max.y - window.min.y + 1; }
  static std::size_t sample_bytes(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }
  void add(const std::string& name, Imf::PixelType type) {
    channels[name] = {type, Bytes(width() * static_cast<std::size_t>(height()) * sample_bytes(type))};
  }
  void add_to(Imf::FrameBuffer& buffer) {
    for (auto& [name, channel] : channels) {
      const std::size_t bytes = sample_bytes(channel.first);
      buffer.insert(name, Imf::Slice::Make(channel.first, channel.second.data(), window, bytes, bytes * width()));
    }
  }
};

/// Smooth with noise, or noise alone: bits of every kind, also of floats that are not finite.
Channels make_channels(Imath::Box2i window, const std::vector<std::pair<std::string, Imf::PixelType>>& wanted,
                       bool noise) {
  std::mt19937 random(3);
  Channels out{window, {}};
  for (const auto& [name, type] : wanted) {
    out.add(name, type);
    Bytes& bytes = out.channels[name].second;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>(noise ? random() : i / 7 + random() % 3);
  }
  return out;
}

Imf::Header header_of(const Channels& channels, Imf::Compression compression) {
  Imf::Header header(Imath::Box2i({-3, -2}, {100, 90}), channels.window);
  header.compression() = compression;
  for (const auto& [name, channel] : channels.channels) header.channels().insert(name, Imf::Channel(channel.first));
  header.insert("note", Imf::StringAttribute("kept"));
  return header;
}

void write_here(const Channels& channels, const Imf::Header& header, const std::filesystem::path& file, int strip) {
  OutputFile out(file);
  ExrLineWriter writer(header, out);
  for (int y = 0; y < channels.height(); y += strip) {
    writer.write(std::min(strip, channels.height() - y), [&](int row, std::uint8_t* line) {
      for (const auto& [name, channel] : channels.channels) {
        const std::size_t bytes = channels.width() * Channels::sample_bytes(channel.first);
        std::memcpy(line + channel_place(header, name), channel.second.data() + bytes * static_cast<std::size_t>(row),
                    bytes);
      }
    });
  }
  writer.finish();
  ASSERT_TRUE(out.close());
}

void write_by_openexr(Channels channels, const Imf::Header& header, const std::filesystem::path& file) {
  Imf::FrameBuffer buffer;
  channels.add_to(buffer);
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(channels.height());
}

Channels read_by_openexr(const std::filesystem::path& file) {
  Imf::InputFile in(file.c_str());
  EXPECT_TRUE(in.isComplete());
  Channels out{in.header().dataWindow(), {}};
  const auto& channels = in.header().channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) out.add(it.name(), it.channel().type);
  Imf::FrameBuffer buffer;
  out.add_to(buffer);
  in.setFrameBuffer(buffer);
  in.readPixels(out.window.min.y, out.window.max.y);
  return out;
}

/// Every attribute, by name, as its file has it.
std::map<std::string, std::string> attributes_of(const std::filesystem::path& file) {
  const Imf::InputFile in(file.c_str());
  std::map<std::string, std::string> out;
  for (auto it = in.header().begin(); it != in.header().end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    out[it.name()] = text ? text->value() : it.attribute().typeName();
  }
  return out;
}

void expect_sound(const std::filesystem::path& file) {
  EXPECT_FALSE(Imf::checkOpenEXRFile(file.c_str(), false, false, true)) << file;
}

using Wanted = std::vector<std::pair<std::string, Imf::PixelType>>;
const Wanted kHalves{{"A", Imf::HALF}, {"B", Imf::HALF}, {"G", Imf::HALF}, {"R", Imf::HALF}};
const Wanted kFloats{{"B", Imf::FLOAT}, {"G", Imf::FLOAT}, {"R", Imf::FLOAT}};
const Wanted kMixed{{"R", Imf::HALF},
                    {"Z", Imf::FLOAT},
                    {"a.layer.with-a-name-of-more-than-31-characters.X", Imf::HALF},
                    {"id", Imf::UINT}};

TEST(ExrLineWriter, FilesAreReadByOpenExrAsItsOwn) {
  const TemporaryFolder folder;
  for (const auto compression : {Imf::ZIP_COMPRESSION, Imf::ZIPS_COMPRESSION})
    for (const Wanted* wanted : {&kHalves, &kFloats, &kMixed})
      for (const bool noise : {false, true})
        for (const Imath::V2i& size :
             {Imath::V2i(1, 1), {1, 40}, {3, 2}, {16, 15}, {17, 16}, {33, 17}, {700, 33}, {5, 300}}) {
          const Channels channels = make_channels({{-3, 7}, {size.x - 4, size.y + 6}}, *wanted, noise);
          const Imf::Header header = header_of(channels, compression);
          ASSERT_TRUE(can_pack_lines(header));
          std::filesystem::remove(folder / "here.exr");
          write_here(channels, header, folder / "here.exr", 48);
          write_by_openexr(channels, header, folder / "openexr.exr");
          const Channels read = read_by_openexr(folder / "here.exr");
          EXPECT_EQ(read.window, channels.window);
          EXPECT_EQ(read.channels, channels.channels) << size.x << "x" << size.y << " " << int{compression} << noise;
          EXPECT_EQ(attributes_of(folder / "here.exr"), attributes_of(folder / "openexr.exr"));
          // The first 8 bytes tell the version, and whether names are long.
          EXPECT_EQ(file_bytes(folder / "here.exr").substr(0, 8), file_bytes(folder / "openexr.exr").substr(0, 8));
          if (size.y < 40) expect_sound(folder / "here.exr");
        }
}

TEST(ExrLineWriter, PacksAsWellAsOpenExr) {
  const TemporaryFolder folder;
  const Channels channels = make_channels({{0, 0}, {499, 99}}, kHalves, false);
  Imf::Header header = header_of(channels, Imf::ZIP_COMPRESSION);
  write_here(channels, header, folder / "here.exr", 256);
  write_by_openexr(channels, header, folder / "openexr.exr");
  EXPECT_LT(static_cast<double>(std::filesystem::file_size(folder / "here.exr")),
            1.02 * static_cast<double>(std::filesystem::file_size(folder / "openexr.exr")));
  header.zipCompressionLevel() = 0;
  write_here(channels, header, folder / "stored.exr", 256);
  EXPECT_EQ(read_by_openexr(folder / "stored.exr").channels, channels.channels);
  EXPECT_GT(std::filesystem::file_size(folder / "stored.exr"), 500u * 100 * 8);
}

TEST(ExrLineWriter, LeavesOtherKindsAlone) {
  const Channels channels = make_channels({{0, 0}, {9, 9}}, kHalves, false);
  EXPECT_FALSE(can_pack_lines(header_of(channels, Imf::PIZ_COMPRESSION)));
  Imf::Header header = header_of(channels, Imf::ZIP_COMPRESSION);
  header.lineOrder() = Imf::DECREASING_Y;
  EXPECT_FALSE(can_pack_lines(header));
  header = header_of(channels, Imf::ZIP_COMPRESSION);
  header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  EXPECT_FALSE(can_pack_lines(header));
  header = header_of(channels, Imf::ZIP_COMPRESSION);
  header.setTileDescription(Imf::TileDescription(16, 16));
  EXPECT_FALSE(can_pack_lines(header));
}

TEST(ExrLineWriter, ADiskThatIsFullIsNoticed) {
  OutputFile full(::open("/dev/full", O_RDWR));
  const Channels channels = make_channels({{0, 0}, {999, 499}}, kHalves, true);
  const Imf::Header header = header_of(channels, Imf::ZIP_COMPRESSION);
  try {
    ExrLineWriter writer(header, full);
    writer.write(500, [](int, std::uint8_t*) {});
    writer.finish();
  } catch (const std::exception&) {  // OpenEXR's, of a header that could not be written
  }
  EXPECT_FALSE(full.close());
  EXPECT_EQ(full.failure(), ENOSPC);
}

}  // namespace
}  // namespace afterglow
