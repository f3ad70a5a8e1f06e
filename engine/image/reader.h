// SPDX-License-Identifier: MIT
// Reads pictures of the formats that picture_format.h names and makes them ready for a stack: layers picked, colour
// decoded to scene-linear Rec.709, alpha associated, orientation applied, values made finite. All functions are
// thread-safe.
// Errors: io (file named), usage (bad option text).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/picture.h"
#include "image/size_limits.h"

namespace afterglow {

class Movie;

/// Memory of pictures that are done, for those that come: the system clears what it hands out, which takes longer than
/// to decode a picture into it. Holds no more than was in use at a time, of one size. Thread-safe.
class PixelMemory {
 public:
  /// So many values; they may be anything.
  std::vector<float> take(std::size_t count);
  /// For 8-bit codes: what a picture had them in, or empty.
  UnsetVector<std::uint8_t> take_codes();
  /// For half floats.
  UnsetVector<std::uint16_t> take_halves(std::size_t count);
  /// Takes the picture, and keeps what it has of that memory.
  void give(Picture&& picture);

 private:
  template <class Values>
  struct Kind {
    std::vector<Values> free;
    std::size_t out = 0;  ///< taken and not given back: no more are kept, as pictures also bring memory of their own
  };
  struct Kept {
    Kind<std::vector<float>> pixels;
    Kind<UnsetVector<std::uint8_t>> codes;
    Kind<UnsetVector<std::uint16_t>> halves;
  };
  template <class Values>
  Values take(Kind<Values> Kept::*kind, std::size_t count);

  std::mutex mutex_;
  std::size_t count_ = 0;  ///< that was asked for last
  Kept kept_;
};

/// `FILE[:NAME]` of --depth, --normal and --motion: another file and/or a channel or layer in it.
struct LayerChoice {
  std::filesystem::path file;  ///< empty: the picture's own file; may be a sequence pattern, resolved by the caller
  std::string name;            ///< channel (depth) or layer (normal, motion); empty: found by the usual names
  bool given() const { return !file.empty() || !name.empty(); }
};
/// Splits at the last ':' whose left side is an existing file or pattern; a text that is no file is taken for a NAME.
LayerChoice parse_layer_choice(const std::string& text);

struct ReadOptions {
  /// --layer: colour layer ("ViewLayer.Combined", "ViewLayer", part name, channel); empty: the first usual one
  std::string layer;
  /// Name of the space that colours are stored in (image/input_space.h), whatever the file says; empty: what it says.
  std::string input_space;
  bool cut_overscan = false;  ///< what lies outside of the display window is left out
  /// Components below 0, which colours outside of Rec.709 have, stay. None: as the look says, else they end at 0.
  std::optional<bool> keep_negative;
  bool raw = false;  ///< numbers as they are stored, whole ones as 0…1: no colours, none made positive, alpha apart
  /// A frame of a video: `file` of the functions below is only its name then.
  std::shared_ptr<Movie> movie;
  int movie_frame = 0;
  LayerChoice depth, normal, motion;
  std::filesystem::path mattes;  ///< where layers are looked for that the picture has not; empty: nowhere
  std::vector<std::string>
      auxiliary;  ///< what the stack asks for: "depth", "normal", "motion", "layer:NAME"; only these are read
  NanPolicy nan_policy = NanPolicy::zero;  ///< fail: a picture with values that are not finite is an error (io)
  int max_side = SizeLimits().max_side;    ///< larger sides are refused from the header
  /// Colours that a file holds as half floats, and that need no more than to be held at 0, may stay so
  /// (Picture::halves).
  bool halves = false;
  PixelMemory* memory = nullptr;         ///< where the colour's pixels are taken from; null: anew
  std::uint64_t max_bytes = 6ull << 30;  ///< pictures whose own host memory would be larger are refused from the header
};

/// What stays open between the header and the pixels.
struct OpenedPicture {
  virtual ~OpenedPicture() = default;
};

/// What the header says; cheap, allocates nothing large. The file stays open until the last copy goes.
struct PictureHeader {
  Rect data_window, display_window;  ///< after orientation
  int channels = 0;
  std::vector<std::string> auxiliary;  ///< "depth", "normal", "motion", layers asked for: those that reading would find
  std::vector<std::string> layers;     ///< names of all layers
  /// Channels that the colour ("color") and what was asked for are taken from; what may be meant by what is not there.
  std::map<std::string, std::string> taken, hints;
  bool has_alpha = false;
  std::shared_ptr<const FileFacts> facts;
  std::string format;            ///< OIIO format name: "openexr", "png", …
  std::uint64_t host_bytes = 0;  ///< host memory that read_picture would take at its peak
  std::shared_ptr<OpenedPicture> opened;
};

/// Whether a file is a picture or a video, by its first bytes.
bool has_pictures(const std::filesystem::path& file);
Result<PictureHeader> read_header(const std::filesystem::path& file, const ReadOptions& options);
/// Reads the picture of a header, which is not parsed again; once. `options` are those that the header was read with.
/// Errors: those of reading a file, other (it was read before).
Result<Picture> read_picture(const PictureHeader& header, const ReadOptions& options, Diagnostics& diagnostics);
Result<Picture> read_picture(const std::filesystem::path& file, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace afterglow
