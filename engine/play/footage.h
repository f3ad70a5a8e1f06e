// SPDX-License-Identifier: MIT
// What is played: single pictures, numbered sequences, videos, or several of them one after the other, as one row of
// frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/cuts.h"
#include "image/movie.h"
#include "image/reader.h"

namespace afterglow {

struct FootageOptions {
  std::vector<std::string> inputs;  ///< files, patterns (shot.####.exr, shot.%04d.exr), videos
  std::string frames;               ///< "1-24x2", for numbered inputs and videos; empty: all there are
  /// Layers and limits; depth and normal may be patterns. What looks need is given to `read`.
  ReadOptions read;
  Cuts cuts;      ///< where looks begin anew
  int proxy = 1;  ///< pictures are read at one part in this of their sides: 1, 2, 4 or 8
  /// Player: one picture that is a frame of a sequence opens that, and stands at the frame.
  bool whole_sequences = false;
};

/// How looks want their pictures to be read.
struct FootageNeeds {
  std::vector<std::string> auxiliary{};  ///< "depth", "normal", as stacks ask for them
  std::string input_space{};             ///< where ReadOptions says none; empty: what pictures say themselves
  std::optional<bool> keep_negative{};   ///< where ReadOptions does not say
  bool operator==(const FootageNeeds&) const = default;
};

/// "1/2" is 2, "1" is 1. Errors: usage (not 1, 1/2, 1/4 or 1/8).
Result<int> parse_proxy(const std::string& text);
/// "1/2".
std::string proxy_name(int proxy);

/// One frame of the row. A missing file of a sequence holds the picture before it (or, at the start, the one behind).
struct FootageFrame {
  int number = 1;   ///< in its sequence: what presets see
  int picture = 0;  ///< which picture it shows: equal numbers, equal pixels
  bool held = false;
  std::optional<double> time{};  ///< of a video's frame: seconds from the video's first one
  bool operator==(const FootageFrame&) const = default;
};

/// Immutable once opened; thread-safe.
class Footage : public std::enable_shared_from_this<Footage> {
 public:
  /// Looks at names and the headers of videos; reads no picture. Errors: usage (patterns, frame lists), io (nothing
  /// matches, a video that cannot be read, a frame list that names no frame that exists).
  static Result<std::shared_ptr<const Footage>> open(const FootageOptions& options, Diagnostics& diagnostics);

  using There = std::function<bool(const std::filesystem::path& file)>;
  /// The same inputs as they are now: a picture keeps its number, one whose file is in `changed` and one that is new
  /// get numbers behind those of `before`. Of a sequence the files are there that `there` says so of. Null: all is as
  /// it was. Without videos. Errors: as open; what was there may be gone.
  static Result<std::shared_ptr<const Footage>> anew(const FootageOptions& options, const Footage& before,
                                                     const std::set<std::filesystem::path>& changed,
                                                     const There& there);

  /// One of the inputs in the row.
  struct Clip {
    std::string label;  ///< for people: "shot.####.exr", "clip.mp4"
    std::string key;    ///< its absolute path: the same clip has the same key wherever it is played
    int first = 0;      ///< position of its first frame
    int frames = 0;
  };
  /// In the order of the row, which they fill.
  const std::vector<Clip>& clips() const { return clips_; }
  /// Which of `clips` a position lies in.
  int clip_at(int position) const;

  int frames() const { return static_cast<int>(frames_.size()); }
  int pictures() const { return static_cast<int>(pictures_.size()); }
  const FootageFrame& frame(int position) const { return frames_[static_cast<std::size_t>(position)]; }
  /// For people: "shot.0007.exr", "clip.mp4, frame 7".
  std::string picture_name(int picture) const;
  const std::filesystem::path& file(int picture) const { return pictures_[static_cast<std::size_t>(picture)].file; }
  /// The video that the picture is of; null: it is of none.
  std::shared_ptr<Movie> movie(int picture) const { return pictures_[static_cast<std::size_t>(picture)].movie; }
  /// Every file that the picture is read from.
  std::vector<std::filesystem::path> files(int picture) const;
  /// Turns a second, where the footage says it (videos). Of a video whose rate varies each frame stays for as many
  /// turns as it shows.
  std::optional<double> fps() const { return fps_; }
  /// Numbers of the frames that are missing and held.
  const std::vector<int>& missing() const { return missing_; }
  /// Pictures in order are read much faster than others.
  bool is_video() const { return video_; }
  bool variable_rate() const { return variable_rate_; }
  int proxy() const { return proxy_; }
  /// The same frames and pictures, read at another size.
  std::shared_ptr<const Footage> at_proxy(int proxy) const;

  /// Reads a picture, with its content hashes noted. A proxy has the mean of what each of its pixels covers, of depth
  /// and normals the nearest (image/scale.h). Errors: io, naming the file.
  Result<Picture> read(int picture, const FootageNeeds& needs, Diagnostics& diagnostics) const;
  /// The same whole, where `read` gives proxies.
  Result<Picture> read_whole(int picture, const FootageNeeds& needs, Diagnostics& diagnostics) const;

 private:
  struct Source {
    std::filesystem::path file;
    int number = 1;
    std::shared_ptr<Movie> movie;
    int movie_frame = 0;
  };
  Footage() = default;
  Result<void> add_inputs(const FootageOptions& options, Diagnostics& diagnostics);
  void renumber(const Footage& before, const std::set<std::filesystem::path>& changed);
  Result<void> add_sequence(const std::string& input, const std::optional<std::vector<int>>& wanted,
                            Diagnostics& diagnostics);
  Result<void> add_movie(const std::filesystem::path& file, const std::optional<std::vector<int>>& wanted,
                         Diagnostics& diagnostics);
  double pace(const Movie& movie, std::vector<int>& turns) const;
  Result<void> add(const std::string& input, const std::optional<std::vector<int>>& wanted, Diagnostics& diagnostics);

  ReadOptions read_;
  There there_;  ///< while it is opened
  std::vector<FootageFrame> frames_;
  std::vector<Source> pictures_;
  std::vector<int> missing_;
  std::vector<Clip> clips_;
  std::optional<double> fps_;
  bool video_ = false, variable_rate_ = false;
  int proxy_ = 1;
};

}  // namespace afterglow
