// SPDX-License-Identifier: MIT
// Truncated and damaged videos: what is whole is used, the rest is named.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "clips.h"
#include "core/file.h"

namespace afterglow {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;

struct DamageCase {
  const char* name;
  const char* arguments;
};
void PrintTo(const DamageCase& one, std::ostream* out) { *out << one.name; }
constexpr const char* kFast = "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -pix_fmt yuv420p";

/// Codecs of sound are not read, which FFmpeg complains of before anything else.
constexpr const char* kFastWithSound =
    "-f lavfi -i sine=duration=2 -c:a aac -c:v libx264 -preset veryfast -crf 12 -g 12 -bf 0 -pix_fmt yuv420p";

class Damage : public Clips, public testing::WithParamInterface<DamageCase> {
 protected:
  std::string altered(const std::string& file, const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    static_cast<void>(file);
    return path(name);
  }
  std::vector<Hash> hashes(const std::string& file) {
    std::vector<Hash> out;
    const auto movie = open(file);
    for (int i = 0; movie && i < movie->frames(); ++i) out.push_back(hash_of(movie, i));
    return out;
  }
};

/// How many frames of `file` equal those of the whole clip, and that every other is named as damaged or missing.
int whole_frames(const std::shared_ptr<Movie>& movie, const std::vector<Hash>& whole) {
  int good = 0;
  for (int i = 0; i < movie->frames(); ++i) {
    ReadOptions options;
    options.movie = movie;
    options.movie_frame = i;
    Diagnostics quiet;
    auto picture = read_picture(movie->file(), options, quiet);
    if (!picture) {
      EXPECT_EQ(picture.error().kind, ErrorKind::io);
      EXPECT_THAT(picture.error().text(), AnyOf(HasSubstr("damaged"), HasSubstr("is missing"))) << i;
      EXPECT_THAT(picture.error().text(), HasSubstr(fmt::format("frame {} ", i + 1)));
      continue;
    }
    note_content(*picture);
    EXPECT_LT(static_cast<std::size_t>(i), whole.size());
    EXPECT_EQ(picture->content.at("source"), whole[static_cast<std::size_t>(i)]) << "frame " << i + 1;
    ++good;
  }
  return good;
}

TEST_P(Damage, ATruncatedClipGivesWhatIsWhole) {
  const std::string file = clip(GetParam().name, GetParam().arguments);
  const std::vector<Hash> whole = hashes(file);
  ASSERT_EQ(whole.size(), 48u);
  const std::string bytes = read_file(file).value();
  const auto movie = open(altered(file, std::string("cut_") + GetParam().name, bytes.substr(0, bytes.size() * 6 / 10)));
  ASSERT_TRUE(movie);
  const int good = whole_frames(movie, whole);
  EXPECT_GT(good, 15);
  EXPECT_LT(good, 45);
  EXPECT_LT(good, movie->frames()) << "the end that is missing must be told";
}

INSTANTIATE_TEST_SUITE_P(
    Video, Damage,
    testing::Values(
        DamageCase{"front.mp4",
                   "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -pix_fmt yuv420p -movflags +faststart"},
        DamageCase{"clip.mkv", kFast}, DamageCase{"sound.mkv", kFastWithSound},
        DamageCase{"clip.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj422p"},
        DamageCase{"vp9.webm", "-c:v libvpx-vp9 -crf 15 -b:v 0 -g 12 -deadline realtime -cpu-used 8"},
        DamageCase{"ffv1.mkv", "-c:v ffv1 -level 3 -slicecrc 1 -g 1 -pix_fmt gbrp"}),
    [](const auto& info) {
      std::string name = info.param.name;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

using Damaged = Damage;

/// Containers without a table, with sound where they hold some, each cut at many places: in a frame, in sound, in a
/// head.
TEST_F(Damaged, AFileThatEndsWithinSomethingIsTold) {
  const std::string sound = "-f lavfi -i sine=r=48000:d=1 ", quiet = "-an ";
  for (const auto& [name, arguments] :
       {std::pair{"a.y4m", quiet + "-pix_fmt yuv444p -f yuv4mpegpipe"},
        std::pair{"a.ogv", sound + "-c:v libtheora -c:a libvorbis"},
        std::pair{"a.mxf", sound + "-r 25 -c:v mpeg2video -c:a pcm_s16le"}, std::pair{"a.gif", quiet + "-c:v gif"},
        std::pair{"a.nut", sound + "-c:v ffv1 -c:a pcm_s16le"},
        std::pair{"a.ts", sound + "-c:v mpeg2video -r 25 -c:a mp2 -f mpegts"},
        std::pair{"a.mpg", sound + "-c:v mpeg2video -r 25 -c:a mp2"},
        std::pair{"a.flv", sound + "-c:v libx264 -preset veryfast -bf 0 -pix_fmt yuv420p -c:a aac -ar 44100"},
        std::pair{"a.ivf", quiet + "-c:v libvpx -deadline realtime"}, std::pair{"a.apng", quiet + "-f apng -c:v apng"},
        std::pair{"a.asf", sound + "-c:v mpeg4 -c:a wmav2"},
        std::pair{"a.webm", sound + "-c:v libvpx -deadline realtime -c:a libopus"}}) {
    SCOPED_TRACE(name);
    const std::string file = clip(name, arguments, 24);
    messages_.clear();
    const auto whole = open(file);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->facts().missing, 0u);
    EXPECT_THAT(messages_, testing::Not(Contains(HasSubstr("truncated"))));
    const std::string bytes = read_file(file).value();
    for (const std::size_t percent : {50, 58, 67, 74, 83, 90}) {
      std::size_t size = bytes.size() * percent / 100;
      if (size % 188 == 0) ++size;  // a transport stream of fewer packets is whole
      const auto cut = open(altered(file, std::string("cut_") + name, bytes.substr(0, size)));
      ASSERT_TRUE(cut);
      EXPECT_EQ(cut->facts().missing, 1u) << percent;
    }
  }
}

/// Places without a picture are none that is missing.
TEST_F(Damaged, AviMayHoldEmptyPlaces) {
  const std::string varies = clip("varies.mkv", "-c:v ffv1 -vf \"select='not(mod(n,3))'\" -vsync vfr", 24);
  for (const char* codec : {"mjpeg -q:v 2", "mpeg4 -g 1 -q:v 2"}) {
    ffmpeg(fmt::format("-i '{}' -c:v {} -vsync vfr -r 24 '{}'", varies, codec, path("varies.avi")));
    const auto whole = open(path("varies.avi"));
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->frames(), 8) << codec;
    EXPECT_EQ(whole->facts().missing, 0u);
    EXPECT_NEAR(whole->time(7), 21 / 24.0, 1e-6);
    const std::string bytes = read_file(path("varies.avi")).value();
    const auto cut = open(altered("", "cut.avi", bytes.substr(0, bytes.size() * 6 / 10)));
    ASSERT_TRUE(cut);
    EXPECT_GT(cut->facts().missing, 1u) << codec;
    EXPECT_LE(cut->facts().missing, 21u);
  }
}

/// What muxers write where they cannot seek: sizes that nobody knew.
TEST_F(Damaged, FilesThatWereWrittenToAPipeAreWhole) {
  for (const char* arguments : {"-c:v libvpx -deadline realtime -f webm", "-c:v ffv1 -f matroska", "-c:v ffv1 -f nut",
                                "-c:v mpeg4 -f asf", "-c:v mjpeg -f avi", "-c:v libtheora -f ogg",
                                "-c:v libvpx -deadline realtime -f ivf", "-c:v gif -f gif", "-c:v apng -f apng"}) {
    const std::string raw = numbered_frames(12);
    ffmpeg(fmt::format("-f rawvideo -pix_fmt rgb24 -s {}x{} -r 24 -i '{}' {} - | tee '{}'", kClipWidth, kClipHeight,
                       raw, arguments, path("piped")));
    const auto movie = open(path("piped"));
    ASSERT_TRUE(movie) << arguments;
    EXPECT_EQ(movie->frames(), 12) << arguments;
    EXPECT_EQ(movie->facts().missing, 0u) << arguments;
  }
}

TEST_F(Damaged, AClipWithoutItsTableIsRefused) {
  const std::string file = clip("clip.mp4", kFast, 12);
  const std::string bytes = read_file(file).value();
  const auto movie = try_open(altered(file, "cut.mp4", bytes.substr(0, bytes.size() / 2)));
  ASSERT_FALSE(movie);
  EXPECT_EQ(movie.error().kind, ErrorKind::io);
  EXPECT_THAT(movie.error().text(), HasSubstr("moov atom not found"));
}

/// A picture that others are built on: they are named too, and the next group of pictures is whole again.
TEST_F(Damaged, FramesBuiltOnADamagedOneAreNamed) {
  const std::string file = clip("clip.mp4", kFast);
  const std::vector<Hash> whole = hashes(file);
  std::string bytes = read_file(file).value();
  const auto movie = open(file);
  // In the middle of the samples: overwritten beyond repair.
  const std::size_t at = bytes.find("mdat") + (bytes.size() / 2);
  for (std::size_t i = 0; i < 600; ++i) bytes[at + i] = static_cast<char>(0xa5 ^ i);
  const auto broken = open(altered(file, "broken.mp4", bytes));
  ASSERT_TRUE(broken);
  const int good = whole_frames(broken, whole);
  EXPECT_GE(good, 24);
  EXPECT_LT(good, 48);
  // The last group of pictures is whole.
  EXPECT_EQ(hash_of(broken, 47), whole[47]);
}

/// FFV1 has checksums: every flipped bit of its slices is found.
TEST_F(Damaged, ChecksumsAreChecked) {
  const std::string file = clip("clip.mkv", "-c:v ffv1 -level 3 -slicecrc 1 -g 1 -pix_fmt gbrp", 24);
  const std::vector<Hash> whole = hashes(file);
  std::string bytes = read_file(file).value();
  bytes[bytes.size() / 2] ^= 4;
  const auto broken = open(altered(file, "broken.mkv", bytes));
  ASSERT_TRUE(broken);
  EXPECT_EQ(whole_frames(broken, whole), 23);
}

/// Decoders of single pictures fill what they could not decode and say so in a message alone.
TEST_F(Damaged, DamagedSlicesOfSinglePicturesAreNoticed) {
  for (const auto& [name, arguments] :
       {std::pair{"p.mov", "-c:v prores_ks -profile:v hq -pix_fmt yuv422p10le"},
        std::pair{"d.mov", "-vf scale=384:192 -c:v dnxhd -profile:v dnxhr_hq -pix_fmt yuv422p"},
        std::pair{"m.mov", "-c:v mjpeg -q:v 2 -pix_fmt yuvj422p"}}) {
    SCOPED_TRACE(name);
    const std::string file = clip(name, arguments, 24);
    const std::vector<Hash> whole = hashes(file);
    std::string bytes = read_file(file).value();
    for (std::size_t i = 0; i < 400; ++i) bytes[bytes.size() / 2 + i] = name[0] == 'p' ? '\0' : '\xff';
    const auto broken = open(altered(file, std::string("broken_") + name, bytes));
    ASSERT_TRUE(broken);
    EXPECT_GE(whole_frames(broken, whole), 22) << name;
  }
}

/// Whatever a stranger's file holds: pictures or errors of the kind `io`, within bounds.
TEST_F(Damaged, FlippedBitsNeverCrash) {
  std::mt19937 random(11);
  for (const auto& [name, arguments] :
       {std::pair{"f.mp4", kFast}, std::pair{"f.mkv", "-c:v libvpx-vp9 -b:v 0 -crf 20 -deadline realtime -cpu-used 8"},
        std::pair{"f.ts", kFast}, std::pair{"f.mov", "-c:v prores_ks -pix_fmt yuv422p10le"},
        std::pair{"f.gif", "-c:v gif"}, std::pair{"f.apng", "-f apng -c:v apng"},
        std::pair{"f.avi", "-c:v mjpeg -pix_fmt yuvj420p"}}) {
    const std::string bytes = read_file(clip(name, arguments, 10)).value();
    for (int round = 0; round < 30; ++round) {
      std::string flipped = bytes;
      for (int i = 0; i < 1 + round; ++i) {
        // Headers are where it hurts: half of the bits lie in the first kilobyte.
        const std::size_t reach = i % 2 == 0 ? std::min<std::size_t>(1024, flipped.size()) : flipped.size();
        flipped[random() % reach] ^= static_cast<char>(1u << random() % 8);
      }
      const auto movie = try_open(altered(name, std::string("flipped_") + name, flipped));
      if (!movie) {
        EXPECT_EQ(movie.error().kind, ErrorKind::io) << movie.error().text();
        EXPECT_EQ(movie.error().text().find('\n'), std::string::npos);
        continue;
      }
      for (int i = 0; i < std::min((*movie)->frames(), 12); ++i)
        if (const auto picture = read(*movie, i); !picture) {
          EXPECT_EQ(picture.error().kind, ErrorKind::io);
        }
    }
  }
}

}  // namespace
}  // namespace afterglow
