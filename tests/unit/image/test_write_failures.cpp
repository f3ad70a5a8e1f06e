// SPDX-License-Identifier: MIT
// Outputs appear whole or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "image/output_file.h"
#include "image/video_target.h"
#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

Picture noise(int width, int height) {
  Picture picture;
  picture.color = Image(width, height, 4);
  unsigned state = 1;
  for (float& v : picture.color.pixels) {
    state = state * 1664525u + 1013904223u;
    v = static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
  }
  picture.has_alpha = true;
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

/// Files of this process cannot grow beyond `bytes`: what a full disk looks like to the writer, for root as well.
class FileSizeCap {
 public:
  explicit FileSizeCap(rlim_t bytes) {
    previous_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit cap = before_;
    cap.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &cap);
  }
  ~FileSizeCap() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, previous_);
  }

 private:
  rlimit before_{};
  void (*previous_)(int) = nullptr;
};

TEST(Lost, AFolderThatIsMovedAwayIsNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  auto target = VideoTarget::open(folder / "out/a.mkv").value();
  ASSERT_TRUE(target->out().write("bytes", 5));
  std::filesystem::rename(folder / "out", folder / "moved");
  const auto done = target->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::io);
  EXPECT_EQ(done.error().file, folder / "out/a.mkv");
  EXPECT_THAT(done.error().message,
              HasSubstr("cannot be written: its folder " + (folder / "out").string() + " is gone"));
}

class FullDisk : public testing::TestWithParam<const char*> {};

TEST_P(FullDisk, LeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const auto file = folder / GetParam();
  const Picture picture = noise(200, 150);
  Diagnostics silent;
  ASSERT_TRUE(write_picture(picture, file, {}, silent));
  const std::size_t whole = file_bytes(file).size();
  write_bytes(file, "the old file");
  for (const double part : {0.0, 0.01, 0.3, 0.9, 0.999}) {
    Result<void> written;
    {
      const FileSizeCap cap(static_cast<rlim_t>(part * static_cast<double>(whole)));
      written = write_picture(picture, file, {}, silent);
    }
    ASSERT_FALSE(written) << "with room for " << part;
    EXPECT_EQ(written.error().kind, ErrorKind::io);
    EXPECT_EQ(written.error().file, file.string());
    EXPECT_THAT(written.error().message, HasSubstr("cannot be written"));
    EXPECT_EQ(file_bytes(file), "the old file");
    EXPECT_EQ(folder.count(), 1) << "a temporary file was left";
  }
}
INSTANTIATE_TEST_SUITE_P(All, FullDisk, testing::Values("o.exr", "o.png", "o.jpg", "o.tif", "o.hdr"),
                         [](const auto& info) { return std::string(info.param).substr(2); });

TEST(WriteFailures, ReasonOfTheSystemIsTold) {
  const TemporaryFolder folder;
  Diagnostics silent;
  const FileSizeCap cap(100);
  EXPECT_THAT(write_picture(noise(100, 100), folder / "o.exr", {}, silent).error().message,
              HasSubstr("File too large"));
  EXPECT_THAT(write_picture(noise(100, 100), folder / "o.png", {}, silent).error().message,
              HasSubstr("File too large"));
}

TEST(WriteFailures, CheckedBeforeTheWork) {
  const TemporaryFolder folder;
  const auto error_of = [](const std::filesystem::path& file) {
    const auto checked = check_output(file, {});
    EXPECT_FALSE(checked) << file;
    return checked ? Error{} : checked.error();
  };
  EXPECT_TRUE(check_output(folder / "o.exr", {}));
  EXPECT_TRUE(check_output(folder / "o.JPEG", {}));
  const Error unknown = error_of(folder / "o.exrr");
  EXPECT_EQ(unknown.kind, ErrorKind::usage);
  EXPECT_EQ(unknown.nearest, ".exr");
  EXPECT_THAT(unknown.allowed, HasSubstr(".png"));
  EXPECT_THAT(error_of(folder / "o").message, HasSubstr("no extension"));
  EXPECT_THAT(error_of(folder / "no/o.exr").message, HasSubstr("does not exist"));
  std::filesystem::create_directory(folder / "d.exr");
  EXPECT_THAT(error_of(folder / "d.exr").message, HasSubstr("folder"));
  write_bytes(folder / "plain", "x");
  EXPECT_FALSE(check_output(folder / "plain/o.exr", {}));
  ASSERT_EQ(mkfifo((folder / "p.exr").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder / "p.exr").message, HasSubstr("regular"));  // never replaced by a rename
}

TEST(WriteFailures, ReadOnlyFolder) {
  if (geteuid() == 0) {
    // Root may write anywhere but where nobody can.
    Diagnostics silent;
    EXPECT_FALSE(write_picture(noise(2, 2), "/proc/o.exr", {}, silent));
    return;
  }
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THAT(check_output(folder / "o.exr", {}).error().message, HasSubstr("cannot be written to"));
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(WriteFailures, TypesThatAFormatCannotHold) {
  const TemporaryFolder folder;
  const auto refused = [&](SampleType type, const char* name) {
    WriteOptions options;
    options.type = type;
    const auto checked = check_output(folder / name, options);
    return !checked && checked.error().kind == ErrorKind::usage;
  };
  EXPECT_TRUE(refused(SampleType::half, "o.png"));
  EXPECT_TRUE(refused(SampleType::uint8, "o.exr"));
  EXPECT_TRUE(refused(SampleType::uint16, "o.jpg"));
  EXPECT_FALSE(refused(SampleType::uint16, "o.png"));
  WriteOptions keep;
  keep.keep_layers = true;
  EXPECT_FALSE(check_output(folder / "o.png", keep));
}

TEST(WriteFailures, PictureWithoutItsPixels) {
  const TemporaryFolder folder;
  Diagnostics silent;
  Picture picture = noise(4, 4);
  picture.data_window.width = 5;
  EXPECT_FALSE(write_picture(picture, folder / "o.exr", {}, silent));
  EXPECT_FALSE(write_picture(Picture{}, folder / "o.exr", {}, silent));
  EXPECT_EQ(folder.count(), 0);
}

TEST(WriteFailures, LinksAreFollowed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "store");
  write_bytes(folder / "store/real.exr", "old");
  std::filesystem::create_symlink(folder / "store/real.exr", folder / "link.exr");
  Diagnostics silent;
  ASSERT_TRUE(write_picture(noise(4, 4), folder / "link.exr", {}, silent));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.exr"));
  EXPECT_EQ(read_or_fail(folder / "store/real.exr").color.size(), (Size{4, 4}));
}

TEST(OutputFile, SeeksReadsAndGrows) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "f");
    const std::string large(600000, 'x');
    ASSERT_TRUE(out.write("abc", 3));
    ASSERT_TRUE(out.write(large.data(), large.size()));
    out.seek(1);
    ASSERT_TRUE(out.write("ZZ", 2));
    out.seek(0);
    char back[4] = {};
    ASSERT_TRUE(out.read(back, 4));
    EXPECT_EQ(std::string(back, 4), "aZZx");
    EXPECT_EQ(out.position(), 4u);
    out.seek(600001);
    EXPECT_FALSE(out.read(back, 4));  // beyond the end
    ASSERT_TRUE(out.close());
    EXPECT_EQ(out.size(), 600003u);
  }
  EXPECT_EQ(file_bytes(folder / "f").substr(0, 5), "aZZxx");
  EXPECT_EQ(file_bytes(folder / "f").size(), 600003u);
  OutputFile again(folder / "f");  // never over a file that is there
  EXPECT_NE(again.failure(), 0);
  OutputFile nowhere(folder / "no/f");
  EXPECT_FALSE(nowhere.write("x", 1));
  EXPECT_FALSE(nowhere.close());
}

}  // namespace
}  // namespace afterglow
