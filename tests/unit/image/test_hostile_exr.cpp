// SPDX-License-Identifier: MIT
// Headers of OpenEXR that ask for more than they bring.
#include <cstring>
#include <stdexcept>

#include "hostile_headers.h"
#include "image/exr_header.h"
#include "raw_exr.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

TEST_F(HostileHeaders, ExrTileSizesWhoseProductRunsOver) {
  // 2²⁹ · 2²⁹ pixels of 2⁶ bytes are 2⁶⁴: nothing at all, to a counter of 64 bits.
  RawExr exr;
  exr.windows(0, 0, 7, 7).channels(16, ExrChannelType::float32).tiles(1 << 29, 1 << 29);
  EXPECT_THAT(refused(exr.single(true)).message, HasSubstr("to decode, more than the 6.0 GiB allowed"));
}

TEST_F(HostileHeaders, ExrTablesOfTilesThatTheFileDoesNotHold) {
  // 2²⁸ tiles of one pixel: OpenEXR would take 2 GiB for their places before it reads the first.
  RawExr exr;
  exr.windows(0, 0, 16383, 16383).compression(4).tiles(1, 1);
  EXPECT_THAT(refused(exr.single(true)).message, HasSubstr("cannot hold its pixels"));
}

TEST_F(HostileHeaders, ExrDeepPartsCountThoughTheyAreNeverRead) {
  RawExr plain, deep;
  plain.windows(0, 0, 3, 3).name("plain", "scanlineimage");
  deep.windows(0, 0, 1 << 28, 1 << 28).tiles(1, 1).name("deep", "deeptile");
  EXPECT_THAT(refused(RawExr::multi({plain, deep})).message, HasSubstr("cannot hold its pixels"));
}

TEST_F(HostileHeaders, ExrManyPartsTogether) {
  // Each could be there, all of them cannot.
  std::vector<RawExr> parts;
  for (int i = 0; i < 500; ++i) {
    RawExr part;
    part.windows(0, 0, 3, 16383).compression(0).name("p" + std::to_string(i), "scanlineimage");
    parts.push_back(part);
  }
  EXPECT_THAT(refused(RawExr::multi(parts)).message, HasSubstr("cannot hold its pixels"));
  parts.assign(5000, parts[0]);
  EXPECT_THAT(refused(RawExr::multi(parts)).message, HasSubstr("has more than 4096 parts"));
}

TEST_F(HostileHeaders, ExrAMillionChannels) {
  RawExr exr;
  exr.windows(0, 0, 7, 7).channels(1'000'000, ExrChannelType::half);
  EXPECT_THAT(refused(exr.single(false)).message, HasSubstr("has more than 4096 channels"));
  RawExr few;
  few.windows(0, 0, 7, 7).channels(5000, ExrChannelType::half);
  EXPECT_THAT(refused(few.single(false)).message, HasSubstr("has more than 4096 channels"));
}

TEST_F(HostileHeaders, ExrWindowsTurnedInsideOut) {
  RawExr exr;
  exr.windows(8, 8, -8, -8);
  EXPECT_THAT(refused(exr.single(false)).message, HasSubstr("the data window is empty"));
  RawExr far;
  far.windows(-2147483647 - 1, 0, 2147483647, 0);
  EXPECT_THAT(refused(far.single(false)).message, HasSubstr("out of range"));
}

TEST_F(HostileHeaders, ExrHeadersThatReadInTwoWays) {
  // OpenEXR does not look at the sizes of values whose types have one, and reads lists until they end. Who goes by the
  // sizes sees another header behind such a value: other windows than those that memory was taken for.
  struct Trick {
    const char *name, *type;
    std::string value;
  };
  const std::vector<Trick> tricks{{"a", "int", std::string(40, '\0')},
                                  {"a", "v2f", std::string(4, '\0')},
                                  {"a", "floatvector", std::string(5, '\0')},
                                  {"a", "stringvector", little(1 << 30, 4) + "x"},
                                  {"a", "stringvector", "xy"},
                                  {"a", "preview", little(65536, 4) + little(16384, 4)},
                                  {"a", "preview", "x"},
                                  {"a", "chlist", std::string(1, '\0')},
                                  {"type", "int", little(1, 4)},
                                  {"chunkCount", "float", little(1, 4)}};
  for (const Trick& trick : tricks) {
    SCOPED_TRACE(std::string(trick.type) + " " + std::to_string(trick.value.size()));
    RawExr exr;
    exr.windows(0, 0, 7, 7).attribute(trick.name, trick.type, trick.value);
    EXPECT_EQ(refused(exr.single(false)).message, std::string("attribute '") + trick.name + "' is malformed");
  }
  RawExr twice;
  twice.windows(0, 0, 7, 7).attribute("dataWindow", "box2i", std::string(16, '\0'));
  EXPECT_EQ(refused(twice.single(false)).message, "attribute 'dataWindow' is there twice");
  RawExr chunks;
  chunks.windows(0, 0, 7, 7).attribute("chunkCount", "int", little(0x7fffffff, 4));
  EXPECT_EQ(refused(chunks.single(false)).message, "the header claims more chunks than the file has");
  // A list of channels that goes on behind the end of its attribute.
  RawExr open;
  open.windows(0, 0, 7, 7).channels(3, ExrChannelType::half);
  std::string bytes = open.single(false);
  const std::size_t size_at = bytes.find(std::string("chlist\0", 7)) + 7;
  --bytes[size_at];
  EXPECT_EQ(refused(bytes).message, "the channel list is malformed");
}

/// Where the table of places begins: its first entry is the place right behind it.
std::size_t table_of(const std::string& bytes, std::size_t chunks) {
  for (std::size_t at = 0; at + 8 * chunks < bytes.size(); ++at) {
    std::uint64_t first = 0;
    std::memcpy(&first, &bytes[at], sizeof first);
    if (first == at + 8 * chunks) return at;
  }
  throw std::runtime_error("no table of chunks");
}

TEST_F(HostileHeaders, ExrTablesThatPointInCircles) {
  for (const bool tiled : {false, true}) {
    OIIO::ImageSpec spec = make_spec(40, 40, {"R", "G", "B"}, OIIO::TypeHalf);
    if (tiled) spec.tile_width = spec.tile_height = 8;
    make_file(folder_ / "whole.exr", {spec}, {marks(40, 40, 3)});
    const std::string whole = file_bytes(folder_ / "whole.exr");
    const auto header = read_exr_header(folder_ / "whole.exr");
    ASSERT_TRUE(header);
    const std::size_t chunks = header.value()[0].chunks();
    ASSERT_EQ(chunks, tiled ? 25u : 3u);
    const std::size_t table = table_of(whole, chunks);
    // Every place is that of the first chunk; of the table itself; beyond the end.
    for (const std::uint64_t place :
         {std::uint64_t{table + 8 * chunks}, std::uint64_t{table}, std::uint64_t{1} << 60}) {
      std::string bytes = whole;
      for (std::size_t i = 0; i < chunks; ++i) std::memcpy(&bytes[table + 8 * i], &place, sizeof place);
      write_bytes(folder_ / "circle.exr", bytes);
      Diagnostics silent;
      const auto picture = read_picture(folder_ / "circle.exr", {}, silent);
      // OpenEXR finds the chunks of some without their table; what it gives then is the picture itself.
      if (picture)
        EXPECT_EQ(picture->color.pixels, read_or_fail(folder_ / "whole.exr").color.pixels) << "at " << place;
      else
        EXPECT_THAT(picture.error().message, HasSubstr("cannot be read"));
    }
  }
}

TEST_F(HostileHeaders, ExrChunksThatGrow) {
  // The lines of the one chunk are 16 MiB of zeros, packed into 16 KiB.
  make_file(folder_ / "whole.exr", 64, 16, {"R"}, OIIO::TypeHalf);
  std::string bytes = file_bytes(folder_ / "whole.exr");
  const std::size_t chunk = table_of(bytes, 1) + 8;
  const std::string bomb = deflated(std::string(16u << 20, '\0'));
  const auto size = static_cast<std::int32_t>(bomb.size());
  bytes.resize(chunk + 8);
  std::memcpy(&bytes[chunk + 4], &size, sizeof size);
  EXPECT_THAT(refused(bytes + bomb).message, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace afterglow
