// SPDX-License-Identifier: MIT
// Which files a run reads and writes: inputs and outputs paired, before any of them is opened.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/earlier_files.h"
#include "core/diagnostics.h"
#include "core/result.h"
#include "image/movie.h"
#include "image/reader.h"
#include "image/sequence.h"

namespace afterglow {

/// A part of a sequence, in frames of it.
struct SequencePart {
  int before = 0;  ///< that come before it
  int length = 0;  ///< 0: to the end
};

struct FrameJob {
  int frame = 1;
  std::filesystem::path input, output;
  LayerChoice depth, normal, motion, mattes{};  ///< patterns resolved for this frame; of mattes the file alone
  /// Frames of one sequence have the same: the pattern, or a file's name without its number.
  std::string sequence{};
  std::shared_ptr<Movie> movie{};  ///< of a video's frame; `input` is the video
  int movie_frame = 0;             ///< in it, from 0
  std::optional<double> time{};    ///< of a video's frame, in seconds from the first
  double fps = 0;                  ///< of the video; 0: unknown
  bool passing = false;            ///< from a stream: its pixels go when it is done
  std::optional<Error> refused{};  ///< of a video that cannot be opened: it fails like a picture that cannot be read
  std::size_t missing = 0;         ///< frames before it that are not there; a video holds their places
  SequencePart part{};             ///< that --frames took, for a video of it alone
  EarlierFiles earlier{};          ///< files of earlier frames that the output depends on
  std::string made_of{};           ///< what is noted behind the output, see resume.h; empty: nothing

  /// Every file that the output is made from.
  std::vector<std::filesystem::path> sources() const;
};

struct FrameListRequest {
  /// Files, patterns, folders that hold one sequence, videos; "-" alone: standard input.
  std::vector<std::string> inputs;
  std::string output;                    ///< file, pattern or folder; a video; "-": standard output
  std::string extension;                 ///< --format, for outputs in a folder; empty: that of the input
  std::string raw;                       ///< --raw: how frames on standard input lie
  SizeLimits limits{};                   ///< of videos and of what comes on standard input
  std::string frames;                    ///< "1-24x2"; empty: all that exist
  bool holds = false;                    ///< of `frames` that are not there the one before is held, as without `frames`
  std::vector<std::string> frames_of{};  ///< of each input, in its place; empty: `frames` is of all
  LayerChoice depth, normal, motion, mattes{};
};

/// Whether all frames go into this one output, a video or standard output.
bool is_one_output(const std::string& output);

/// The folder that an output `NAME/` stands for when it is not there yet, else empty. It comes with the first picture
/// that is written into it.
std::filesystem::path new_folder(const std::string& output);
/// Makes it unless it is there, or empty; what it lies in must be there. Errors: io.
Result<void> make_folder(const std::filesystem::path& folder);

/// A frame of a sequence, without an output. Errors: usage (a pattern for depth or normal that is none).
Result<FrameJob> job_of(const FrameListRequest& request, const std::string& sequence, const FrameFile& file);

/// A frame of a video, without an output.
Result<FrameJob> job_of(const FrameListRequest& request, const std::shared_ptr<Movie>& movie, int frame);

struct FrameList {
  std::vector<FrameJob> jobs;
  /// When not empty, standard input goes on behind them: the next frame, or none at its end.
  std::function<Result<std::optional<FrameJob>>()> more;
  std::shared_ptr<const MemoryFile> file;  ///< what came on standard input, when it is a job's file
};

/// Counts FrameJob::missing in the frames of one sequence, which rise.
void hold_missing(std::vector<FrameJob>& jobs);

/// Opens videos and standard input. Warns of frames that are missing in sequences that are taken whole; where one goes
/// into a video alone, their places are held. Errors: usage (a plain output for several frames, two inputs for one
/// output, an output that is an input), io (nothing matches, no place for the outputs).
Result<FrameList> list_frames(const FrameListRequest& request, Diagnostics& diagnostics);

}  // namespace afterglow
