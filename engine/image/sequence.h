// SPDX-License-Identifier: MIT
// Numbered files: `shot.####.exr`, `shot.%04d.exr`, frame ranges `1-24`, `1-24x2`, lists `1,5,10-12`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"

namespace afterglow {

/// Frames in the order given, without repetition. Errors: usage. At most 1,000,000 frames.
Result<std::vector<int>> parse_frames(const std::string& text);
/// "1-24,30,32-40x2": what parse_frames makes the same frames of. Frames in their order, each once.
std::string frames_text(const std::vector<int>& frames);

/// A file name with one place for a frame number, or a plain file.
struct Pattern {
  std::string prefix, suffix;
  int digits = 0;  ///< at least this many, zero-padded
  bool numbered = false;
  std::filesystem::path file(int frame) const;
  /// The same, with all digits behind the sign of frames before zero: "-0003", as Blender writes them; C has "-003".
  std::filesystem::path file_with_sign(int frame) const;
  /// The one of both that is there; `file` where none is.
  std::filesystem::path existing(int frame) const;
};
/// Errors: usage (two places, an unknown % code).
Result<Pattern> parse_pattern(const std::string& text);

/// Where the number that ends at `end` of a name begins; at `end` where there is none. A minus sign belongs to it
/// behind a point, an underscore or nothing: "shot.-002", but not "shot-2".
std::size_t number_begin(std::string_view name, std::size_t end);

/// Of a name that has a number: where its last one lies, with its sign; the extension is left out, and so are numbers
/// with a letter behind them ("1080p", "25fps"). `digits` is 0 where there is none; with more than kMostFrameDigits it is
/// no frame's.
struct FrameNumber {
  std::size_t begin = 0, end = 0;
  int digits = 0;
};
inline constexpr int kMostFrameDigits = 9;  // what always fits an int
FrameNumber frame_number(const std::filesystem::path& file);
/// The number that lies there; none where it is no frame's.
std::optional<int> own_frame_number(const std::filesystem::path& file);
/// A file's path with "*" in place of its frame's number: the same for all frames of a sequence.
std::string without_frame_number(const std::filesystem::path& file);

struct FrameFile {
  int frame = 0;
  std::filesystem::path file;
};
/// Files with a number in the pattern's place that are none of its frames: they have other digits, too large a number,
/// or that of a frame that is there.
struct LeftOut {
  std::size_t files = 0;
  std::filesystem::path first;  ///< by name
  void add(const std::filesystem::path& file);
  /// "a.exr is", "a.exr and 3 more are".
  std::string names() const;
  /// A warning, where there are any. `input`: as the user wrote the pattern.
  void tell(const std::string& input, const Pattern& pattern, Diagnostics& diagnostics) const;
};

/// The files of the pattern that exist, by number; with `frames` exactly those (missing ones are listed too: reading
/// reports them). A plain file is one frame: that of its number, else 1. Errors: io (no file matches).
Result<std::vector<FrameFile>> find_frames(const Pattern& pattern, const std::optional<std::vector<int>>& frames,
                                           LeftOut* left_out = nullptr);

/// The pattern of the one sequence of pictures in a folder: "shots/shot.####.exr". Errors: io (none, several: named).
/// Pictures whose names have no number go into `others`.
Result<std::string> sequence_in(const std::filesystem::path& folder, LeftOut* others = nullptr);
/// The sequence around a picture: its pattern, and which of its frames that is.
struct SequenceFrame {
  std::string pattern;
  int frame = 0;
};
/// None: the name has no number, or no picture with the number before or behind it lies beside it.
std::optional<SequenceFrame> sequence_around(const std::filesystem::path& file);
/// Pictures with the sequences around them in place of those that have one, each once.
std::vector<std::string> in_sequences(const std::vector<std::string>& pictures);
/// Inputs with the sequences of the folders among them.
Result<std::vector<std::string>> with_sequences(std::vector<std::string> inputs, Diagnostics& diagnostics);

}  // namespace afterglow
