// SPDX-License-Identifier: MIT
// Clips whose frames carry their number, made by the program ffmpeg.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/hash.h"
#include "image/movie.h"
#include "image/reader.h"

namespace afterglow {

inline constexpr int kClipWidth = 192, kClipHeight = 96;

/// A folder of its own for each test, removed at its end.
class Clips : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Raw RGB24 frames first..first+count−1: the number as black and white bars above, a picture that moves below.
  std::string numbered_frames(int count, int first = 1, bool alpha = false) const;
  /// `ffmpeg -f rawvideo … -i RAW ARGUMENTS NAME`, at 24 frames a second. Returns the file.
  std::string clip(const std::string& name, const std::string& arguments, int count = 48, bool alpha = false) const;
  /// Runs the program ffmpeg; a failure fails the test.
  void ffmpeg(const std::string& arguments) const;

  std::shared_ptr<Movie> open(const std::string& file);
  Result<std::shared_ptr<Movie>> try_open(const std::string& file);
  static Result<Picture> read(const std::shared_ptr<Movie>& movie, int frame);
  static Hash hash_of(const std::shared_ptr<Movie>& movie, int frame);
  /// The number that the picture's bars say.
  static int number_of(const Picture& picture);

  /// The numbers of the frames that the program ffmpeg decodes from the beginning.
  std::vector<int> numbers_by_ffmpeg(const std::string& file) const;

  std::vector<std::string> messages_;

 private:
  std::filesystem::path folder_;
};

}  // namespace afterglow
