// SPDX-License-Identifier: MIT
// Zips as packs: what is unpacked, and what is refused before anything is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <minizip/zip.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "core/file.h"
#include "core/pack.h"
#include "core/zip_bytes.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

struct Item {
  std::string name, content;
  mode_t mode = S_IFREG | 0644;
};

struct Pack : testing::Test {
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "afterglow-pack-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
  }
  void TearDown() override { fs::remove_all(folder); }

  fs::path make(const std::vector<Item>& items, const std::string& name = "look.zip") const {
    const fs::path file = folder / name;
    zipFile zip = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
    for (const auto& item : items) {
      zip_fileinfo info{};
      info.external_fa = static_cast<uLong>(item.mode) << 16;
      EXPECT_EQ(zipOpenNewFileInZip4_64(zip, item.name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 9,
                                        0, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY, nullptr, 0, 3 << 8, 0, 0),
                ZIP_OK);
      EXPECT_EQ(zipWriteInFileInZip(zip, item.content.data(), static_cast<unsigned>(item.content.size())), ZIP_OK);
      EXPECT_EQ(zipCloseFileInZip(zip), ZIP_OK);
    }
    EXPECT_EQ(zipClose(zip, nullptr), ZIP_OK);
    return file;
  }
  Result<fs::path> open(const fs::path& zip, const PackLimits& limits = {}) const {
    return open_zip(zip, folder / "cache", limits);
  }
  // The message without the file's name; what was refused leaves nothing behind.
  std::string error(const fs::path& zip, const PackLimits& limits = {}) const {
    const auto opened = open(zip, limits);
    if (opened) return "";
    EXPECT_EQ(opened.error().kind, ErrorKind::script);
    EXPECT_EQ(opened.error().file, zip.string());
    EXPECT_THAT(left_behind(), IsEmpty());
    return opened.error().message;
  }
  std::vector<std::string> left_behind() const {
    std::vector<std::string> names;
    std::error_code ec;
    for (fs::recursive_directory_iterator it(folder / "cache", ec), end; !ec && it != end; it.increment(ec))
      if (!it->is_directory()) names.push_back(it->path().string());
    return names;
  }
  fs::path folder;
};

TEST_F(Pack, UnpacksOnceUnderItsName) {
  const fs::path zip = make({{"effects/", "", S_IFDIR | 0755}, {"effects/haze.lua", "return 1"}, {"a/b/c.txt", ""}});
  const auto opened = open(zip);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(opened->filename(), "look.zip");
  EXPECT_EQ(read_file(*opened / "effects/haze.lua").value(), "return 1");
  EXPECT_EQ(read_file(*opened / "a/b/c.txt").value(), "");
  const auto made = fs::last_write_time(*opened / "effects/haze.lua");
  EXPECT_EQ(open(zip).value(), *opened);
  EXPECT_EQ(fs::last_write_time(*opened / "effects/haze.lua"), made) << "unpacked a second time";
  EXPECT_EQ(left_behind().size(), 2u);
}

TEST_F(Pack, AFolderThatWasZippedWholeIsWhatIsInIt) {
  const auto has = [&](const std::vector<Item>& items, const char* file, const std::string& name) {
    const auto opened = open(make(items, name));
    return opened && fs::exists(*opened / file);
  };
  const Item noise{"__MACOSX/mine/._haze.lua", "x"}, store{"mine/.DS_Store", "x"};
  EXPECT_TRUE(has({{"mine/effects/haze.lua", ""}, {"mine/read.me", ""}, noise, store}, "effects/haze.lua", "1.zip"));
  EXPECT_TRUE(has({{"mine/warm.lua", ""}, {"mine/luts/a.cube", ""}}, "luts/a.cube", "mine.zip"));
  // Names of a pack are not taken apart.
  EXPECT_TRUE(has({{"effects/masks/haze.lua", ""}}, "effects/masks/haze.lua", "2.zip"));
  EXPECT_TRUE(has({{"luts/film/a.cube", ""}}, "luts/film/a.cube", "3.zip"));
  EXPECT_TRUE(has({{"lib/taps.lua", ""}}, "lib/taps.lua", "4.zip"));
  EXPECT_TRUE(has({{"mine/effects/haze.lua", ""}, {"other.lua", ""}}, "mine/effects/haze.lua", "5.zip"));
}

TEST_F(Pack, WhatIsBrokenInTheCacheIsMadeAnew) {
  const fs::path zip = make({{"a.txt", "one"}, {"b.txt", "two"}});
  const fs::path opened = open(zip).value();
  fs::remove(opened / "a.txt");
  std::ofstream(opened / "b.txt") << "longer than it was";
  EXPECT_EQ(open(zip).value(), opened);
  EXPECT_EQ(read_file(opened / "a.txt").value(), "one");
  EXPECT_EQ(read_file(opened / "b.txt").value(), "two");
}

TEST_F(Pack, WhatIsOfTheSameSizeInTheCacheIsLookedInto) {
  const fs::path zip = make({{"a.txt", "one"}, {"b.txt", "two"}});
  const fs::path opened = open(zip).value();
  std::ofstream(opened / "b.txt") << "not";
  EXPECT_EQ(open(zip).value(), opened);
  EXPECT_EQ(read_file(opened / "b.txt").value(), "two");
}

TEST_F(Pack, IsUnpackedFromTheBytesThatWereRead) {
  const fs::path first = make({{"a.txt", "one"}}, "first.zip");
  const std::string bytes = read_file(first).value();
  const Zip zip = open_zip_bytes(bytes);
  ASSERT_NE(zip, nullptr);
  ASSERT_EQ(unzGoToFirstFile(zip.get()), UNZ_OK);
  ASSERT_EQ(unzOpenCurrentFile(zip.get()), UNZ_OK);
  std::string content(10, ' ');
  content.resize(static_cast<std::size_t>(std::max(0, unzReadCurrentFile(zip.get(), content.data(), 10))));
  EXPECT_EQ(content, "one");
  EXPECT_EQ(unzCloseCurrentFile(zip.get()), UNZ_OK);
  EXPECT_EQ(open_zip_bytes("no zip"), nullptr);
  EXPECT_EQ(open_zip_bytes(""), nullptr);
}

TEST_F(Pack, NewContentIsANewFolder) {
  const fs::path first = open(make({{"a.txt", "one"}})).value();
  const fs::path second = open(make({{"a.txt", "two"}})).value();
  EXPECT_NE(first, second);
  EXPECT_EQ(read_file(second / "a.txt").value(), "two");
}

TEST_F(Pack, TheSameContentUnderTwoNames) {
  const fs::path zip = make({{"a.txt", "one"}});
  fs::copy_file(zip, folder / "other.zip");
  EXPECT_EQ(read_file(open(zip).value() / "a.txt").value(), "one");
  EXPECT_EQ(read_file(open(folder / "other.zip").value() / "a.txt").value(), "one");
  EXPECT_EQ(read_file(open(zip).value() / "a.txt").value(), "one");
}

TEST_F(Pack, NamesThatClimbOut) {
  for (const std::string name : {"../evil.lua", "effects/../../evil.lua", "/etc/evil", "a//b", "./a", "a/.", "..",
                                 "a\\..\\..\\b", "C:evil", "a\nb", "con|x"}) {
    EXPECT_THAT(error(make({{"fine.lua", "x"}, {name, "evil"}})), HasSubstr("is not the name of a file inside it"))
        << name;
    EXPECT_FALSE(fs::exists(folder / "evil.lua"));
  }
  EXPECT_EQ(error(make({{"a/b/c/d", "x"}}), {.depth = 3}), "");
  fs::remove_all(folder / "cache");
  EXPECT_THAT(error(make({{"a/b/c/d/e", "x"}}), {.depth = 3}), HasSubstr("'a/b/c/d/e' is not the name"));
  EXPECT_THAT(error(make({{std::string(401, 'x'), "x"}})), HasSubstr("is not the name"));
  EXPECT_THAT(error(make({{std::string(3000, 'x'), "x"}})), HasSubstr("a name in it is too long"));
}

TEST_F(Pack, LinksAndDevices) {
  EXPECT_EQ(error(make({{"effects", "/etc", S_IFLNK | 0777}})), "the pack is refused: 'effects' is a link or a device");
  EXPECT_EQ(error(make({{"pipe", "", S_IFIFO | 0666}})), "the pack is refused: 'pipe' is a link or a device");
}

TEST_F(Pack, Bombs) {
  const std::string zeros(3u << 20, '\0');
  EXPECT_EQ(error(make({{"zeros", zeros}})), "the pack is refused: 'zeros' grows more than 200 times");
  EXPECT_EQ(error(make({{"zeros", zeros}}), {.file_bytes = 2u << 20}),
            "the pack is refused: 'zeros' is larger than 2 MiB");
  const PackLimits four_mib{.total_bytes = 4u << 20, .ratio = 1u << 20};
  EXPECT_EQ(error(make({{"a", zeros}, {"b", zeros}}), four_mib), "the pack is refused: it unpacks to more than 4 MiB");
  EXPECT_EQ(error(make({{"a", ""}, {"b", ""}, {"c", ""}}), {.files = 2}),
            "the pack is refused: it holds more than 2 files");
  EXPECT_EQ(error(make({{"a", "text"}}), {.zip_bytes = 50}), "is larger than 50 bytes");
}

TEST_F(Pack, TwiceTheSameName) {
  EXPECT_EQ(error(make({{"a.lua", "1"}, {"A.lua", "2"}})), "the pack is refused: 'A.lua' is there twice");
}

TEST_F(Pack, FilesThatAreFoldersToo) {
  const auto opened = open(make({{"a", "1"}, {"a/b", "2"}}));
  ASSERT_FALSE(opened);
  EXPECT_THAT(left_behind(), IsEmpty());
}

TEST_F(Pack, NoZipAtAll) {
  std::ofstream(folder / "text.zip") << "this is not a zip";
  EXPECT_EQ(error(folder / "text.zip"), "the pack is refused: it is no zip");
  std::ofstream(folder / "empty.zip") << "";
  EXPECT_EQ(error(folder / "empty.zip"), "the pack is refused: it is no zip");
  EXPECT_EQ(error(make({{"effects/", "", S_IFDIR | 0755}})), "the pack is refused: it holds no files");
  EXPECT_EQ(error(folder / "missing.zip"), "no such file");
}

// Any single byte may be wrong: an error or a whole pack, never a crash or half a pack.
TEST_F(Pack, DamageAnywhere) {
  const std::string good = read_file(make({{"effects/a.lua", "return { 1, 2, 3 }"}, {"b.lua", "return 4"}})).value();
  std::size_t refusals = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(~bad[i]);
    const fs::path file = folder / "bad.zip";
    std::ofstream(file, std::ios::binary) << bad;
    const auto opened = open(file);
    refusals += !opened;
    if (opened) {
      EXPECT_FALSE(fs::is_empty(*opened));
    }
    EXPECT_FALSE(fs::exists(folder / "effects"));
    fs::remove_all(folder / "cache");
  }
  EXPECT_GT(refusals, good.size() / 3);
  for (std::size_t size = 0; size + 22 < good.size(); size += 7) {  // the last 22 bytes are the end's own record
    std::ofstream(folder / "bad.zip", std::ios::binary) << good.substr(0, size);
    EXPECT_FALSE(open(folder / "bad.zip")) << size;
  }
}

// A header that promises less than comes out.
TEST_F(Pack, SizesThatLie) {
  const fs::path zip = make({{"a.txt", std::string(5000, 'x')}});
  std::string bytes = read_file(zip).value();
  const std::size_t central = bytes.rfind("PK\x01\x02");
  ASSERT_NE(central, std::string::npos);
  bytes[central + 24] = 16;  // uncompressed size: 5000 becomes 16
  bytes[central + 25] = 0;
  std::ofstream(zip, std::ios::binary) << bytes;
  EXPECT_THAT(error(zip), HasSubstr("'a.txt' is damaged"));
}

}  // namespace
}  // namespace afterglow
