// SPDX-License-Identifier: MIT
// Exit code 4 for pictures that cannot be used: one line, at once, and nothing left behind.
#include <OpenImageIO/imageio.h>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class BadInput : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
  }

  /// Runs the preset on `input` and expects a refusal that says `message`.
  void expect_refusal(const std::string& input, const std::string& message,
                      const std::vector<std::string>& more = {}) const {
    const auto before = files();
    std::vector<std::string> arguments{"run", "look.lua", input, "-o", "out.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr(input));
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_EQ(files(), before) << "something was left behind";
  }

  /// A run that needs more than --max-memory for a picture of 24 million pixels, and is refused.
  Outcome refuse_large(const std::vector<std::string>& more) const {
    make_flat("large.exr", 6000, 4000);
    std::vector<std::string> arguments{"run", "look.lua", "large.exr", "-o", "out.png", "--max-memory", "256M"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_TRUE(is_one_error_line(outcome.err));
    return outcome;
  }

  /// A picture of zeros that compresses to next to nothing.
  void make_flat(const std::string& name, int width, int height, int channels = 3) const {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::HALF);
    spec.attribute("compression", "zip");
    auto out = OIIO::ImageOutput::create(text(name));
    const std::vector<float> row(static_cast<std::size_t>(width) * channels);
    ASSERT_TRUE(out->open(text(name), spec));
    for (int y = 0; y < height; ++y) ASSERT_TRUE(out->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, row.data()));
    ASSERT_TRUE(out->close());
  }
};

TEST_F(BadInput, Missing) { expect_refusal("none.exr", "no such file"); }

TEST_F(BadInput, Truncated) {
  make_truncated_exr("cut.exr");
  expect_refusal("cut.exr", "cannot be read");
}

TEST_F(BadInput, Empty) {
  write("empty.exr", "");
  expect_refusal("empty.exr", "is empty");
}

TEST_F(BadInput, NoPicture) {
  write("text.exr", std::string(4000, 'x'));
  expect_refusal("text.exr", "is not a picture in a format that is known; allowed: EXR");
}

TEST_F(BadInput, Folder) {
  fs::create_directory(path("folder.exr"));
  expect_refusal("folder.exr", "the folder holds no numbered pictures");
}

TEST_F(BadInput, UnknownLayer) {
  make_exr("a.exr");
  expect_refusal("a.exr", "Beauty", {"--layer", "Beauty"});
}

TEST_F(BadInput, SideAbove16384IsRefusedFromTheHeader) {
  make_flat("wide.exr", 16385, 2);
  expect_refusal("wide.exr", "16384");
}

TEST_F(BadInput, SideOf16384IsFine) {
  make_flat("wide.exr", 16384, 2);
  const Outcome outcome = run({"run", "look.lua", "wide.exr", "-o", "out.exr"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
}

TEST_F(BadInput, NeedAboveMaxMemoryIsRefusedFromTheHeader) {
  // The limit is what the picture needs, not what is left of it after reading: 24 million pixels of 16 bytes are 366
  // MiB alone.
  const Outcome outcome = refuse_large({"--report", "report.json"});
  EXPECT_THAT(outcome.err, HasSubstr("large.exr"));
  EXPECT_FALSE(fs::exists(path("out.png")));
  EXPECT_THAT(outcome.err, HasSubstr("large.exr: error: 6000x4000 pixels need about"));
  EXPECT_THAT(outcome.err, HasSubstr("allowed: a larger --max-memory, or a smaller "));
  // Nothing as large as the picture was ever allocated.
  const std::string report = read("report.json");
  const auto at = report.find("\"peak\": ");
  ASSERT_NE(at, std::string::npos) << report;
  EXPECT_LT(std::stoull(report.substr(at + 8)), 512ull << 20);
}

TEST_F(BadInput, NeedOfASmallerPictureTellsTheSource) {
  const Outcome outcome = refuse_large({"--size", "10%"});
  EXPECT_THAT(outcome.err, HasSubstr("600x400 pixels of a picture of 6000x4000 need about"));
  EXPECT_THAT(outcome.err, HasSubstr("of them to read it, more than the 256 MiB allowed (--max-memory); allowed: a "
                                     "larger --max-memory, or a smaller file"));
}

TEST_F(BadInput, SequenceWithoutFiles) { expect_refusal("shot.####.exr", "no file matches"); }

/// One among several is a frame that fails; the others are made.
TEST_F(BadInput, AVideoAmongPictures) {
  make_exr("a.exr", 8, 8);
  make_exr("z.exr", 8, 8);
  write("broken.mp4", std::string("\0\0\0\x18"
                                  "ftypisom\0\0\2\0isomiso2",
                                  24));
  fs::create_directory(path("out"));
  const Outcome outcome = run({"run", "look.lua", "a.exr", "broken.mp4", "z.exr", "-o", "out/"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("broken.mp4: error: "));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 3 frames failed"));
  EXPECT_TRUE(fs::exists(path("out/a.exr")) && fs::exists(path("out/z.exr")));
  EXPECT_FALSE(fs::exists(path("out/broken.mp4.png")));
  // Stills are told by the brands that their files are compatible with: this one is no video, but damaged.
  write("still.heic", std::string("\0\0\0\x18"
                                  "ftypx\1\2\3\0\0\0\0mif1heic",
                                  24));
  expect_refusal("still.heic", "");
  EXPECT_THAT(run({"run", "look.lua", "still.heic", "-o", "out.png"}).err, Not(HasSubstr("no video")));
}

}  // namespace
}  // namespace afterglow::test
