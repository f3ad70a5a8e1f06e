// SPDX-License-Identifier: MIT
#include "batch/frame_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "core/file.h"
#include "core/text.h"
#include "image/sequence.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

Error usage(std::string message) { return {ErrorKind::usage, std::move(message)}; }

/// `FILE` of a --depth or --normal choice for one frame.
Result<LayerChoice> resolve(const LayerChoice& choice, int frame) {
  if (choice.file.empty()) return choice;
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(choice.file.string()));
  return LayerChoice{pattern.existing(frame), choice.name};
}

/// Whether it can be made: what it lies in is there.
Result<void> check_new_folder(const fs::path& folder) {
  std::error_code ec;
  if (fs::exists(folder, ec)) return Error{ErrorKind::io, "is not a folder", folder.string()};
  return check_place(folder);
}

/// Turns an input into its output's name.
class OutputNames {
 public:
  static Result<OutputNames> parse(const FrameListRequest& request) {
    OutputNames names;
    std::error_code ec;
    if (is_one_output(request.output)) return one_of(request);
    names.is_folder_ = request.output.ends_with('/') || fs::is_directory(request.output, ec);
    names.folder_ = request.output;
    names.extension_ = request.extension;
    if (!names.extension_.empty() && names.extension_[0] != '.') names.extension_ = "." + names.extension_;
    if (const fs::path folder = new_folder(request.output); !folder.empty()) AFTERGLOW_CHECK(check_new_folder(folder));
    if (!names.is_folder_) {
      AFTERGLOW_CHECK(check_extension(request.output));
      AFTERGLOW_TRY(names.pattern_, parse_pattern(request.output));
      if (!names.extension_.empty())
        return usage("--format is for outputs in a folder; a file name says its format itself");
    }
    return names;
  }

  bool takes_all() const { return takes_all_; }
  bool one_file() const { return !is_folder_ && !takes_all_ && !pattern_.numbered; }
  fs::path name(const fs::path& input, int frame) const {
    if (!is_folder_) return pattern_.file(frame);
    fs::path name = input.filename();
    if (!extension_.empty()) name.replace_extension(extension_);
    return folder_ / name;
  }
  /// Of a frame of a video or of standard input.
  Result<fs::path> numbered(const fs::path& input, int frame) const {
    if (!is_folder_) return pattern_.file(frame);
    if (extension_.empty()) return usage("frames of a video in a folder need --format, as in --format exr");
    const std::string stem = input == "-" ? "frame" : input.stem().string();
    return folder_ / fmt::format("{}.{:04}{}", stem, frame, extension_);
  }

 private:
  static Result<OutputNames> one_of(const FrameListRequest& request) {
    OutputNames names;
    AFTERGLOW_TRY(names.pattern_, parse_pattern(request.output));
    if (names.pattern_.numbered)
      return usage(fmt::format("a video takes all frames; {} would be one for each", request.output));
    names.takes_all_ = true;
    if (request.output != "-" && !request.extension.empty())
      return usage("--format is for outputs in a folder and for standard output; a file name says its format itself");
    return names;
  }

  bool is_folder_ = false, takes_all_ = false;
  fs::path folder_;
  std::string extension_;
  Pattern pattern_;
};

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ec;
  return fs::equivalent(a, b, ec);
}

/// Of the first frame of another video.
Error several_videos(const FrameJob& first, const FrameJob& other) {
  Error error = usage(
      fmt::format("{} and {} are videos, and one video is made of one", first.input.string(), other.input.string()));
  error.allowed = "a run for each; ffmpeg -f concat joins what they make";
  return error;
}

/// Frames of two videos have the same numbers.
Error one_place(const FrameJob& job, const std::filesystem::path& earlier) {
  Error error = usage(
      fmt::format("{} and {} would both be written to {}", earlier.string(), job.input.string(), job.output.string()));
  if (job.movie) error.allowed = "a folder like out/, where frames have the names of their videos; a run for each";
  return error;
}

Result<void> check_outputs(const std::vector<FrameJob>& jobs, bool one) {
  for (std::size_t i = 1; i < jobs.size() && is_video_output(jobs[i].output); ++i)
    if (jobs[i].movie && jobs[i - 1].movie && jobs[i].movie != jobs[i - 1].movie)
      return several_videos(jobs[i - 1], jobs[i]);
  std::map<fs::path, fs::path> made_from;
  for (const auto& job : jobs) {
    const auto [at, is_new] = made_from.emplace(job.output, job.input);
    if (!is_new && !one) return one_place(job, at->second);
    for (const auto& source : job.sources())
      if (same_file(source, job.output))
        return usage(fmt::format("{} would be overwritten by its own result", source.string()));
  }
  return {};
}

}  // namespace

bool is_one_output(const std::string& output) { return output == "-" || is_video_output(output); }

fs::path new_folder(const std::string& output) {
  std::error_code ec;
  return output.ends_with('/') && !fs::is_directory(output, ec) ? fs::path(output).parent_path() : fs::path();
}

Result<void> make_folder(const fs::path& folder) {
  std::error_code ec;
  if (folder.empty() || fs::create_directory(folder, ec) || !ec) return {};
  return Error{ErrorKind::io, fmt::format("cannot be made: {}", ec.message()), folder.string()};
}

Result<FrameJob> job_of(const FrameListRequest& request, const std::string& sequence, const FrameFile& file) {
  FrameJob job{.frame = file.frame,
               .input = file.file,
               .output = {},
               .depth = {},
               .normal = {},
               .motion = {},
               .sequence = sequence};
  AFTERGLOW_TRY(job.depth, resolve(request.depth, file.frame));
  AFTERGLOW_TRY(job.normal, resolve(request.normal, file.frame));
  AFTERGLOW_TRY(job.motion, resolve(request.motion, file.frame));
  AFTERGLOW_TRY(job.mattes, resolve(request.mattes, file.frame));
  return job;
}

std::vector<fs::path> FrameJob::sources() const {
  std::vector<fs::path> files{input};
  if (!depth.file.empty()) files.push_back(depth.file);
  if (!normal.file.empty()) files.push_back(normal.file);
  if (!motion.file.empty()) files.push_back(motion.file);
  if (!mattes.file.empty()) files.push_back(mattes.file);
  return files;
}

Result<FrameJob> job_of(const FrameListRequest& request, const std::shared_ptr<Movie>& movie, int frame) {
  AFTERGLOW_TRY(FrameJob job, job_of(request, movie->file().string(), {frame + 1, movie->file()}));
  job.movie = movie;
  job.movie_frame = frame;
  job.time = movie->time(frame);
  job.fps = movie->fps();
  return job;
}

namespace {

/// Frames of a stream become jobs one by one.
class StreamJobs {
 public:
  StreamJobs(const FrameListRequest& request, OutputNames names, std::unique_ptr<MovieStream> stream)
      : request_(request), names_(std::move(names)), stream_(std::move(stream)) {}

  Result<std::optional<FrameJob>> next() {
    AFTERGLOW_TRY(const MovieStream::Frame frame, stream_->next());
    if (!frame.movie) return std::optional<FrameJob>();
    if (++count_ > 1 && names_.one_file())
      return usage(
          fmt::format("more than one frame comes on standard input; {} takes one: give a pattern like "
                      "out.####.png or a folder",
                      request_.output));
    AFTERGLOW_TRY(FrameJob job, job_of(request_, frame.movie, 0));
    job.frame = count_;
    job.time = frame.time;
    job.fps = stream_->fps();
    job.passing = true;
    AFTERGLOW_TRY(job.output, names_.numbered("-", count_));
    return std::optional<FrameJob>(std::move(job));
  }

 private:
  FrameListRequest request_;
  OutputNames names_;
  std::shared_ptr<MovieStream> stream_;
  int count_ = 0;
};

Result<void> add_movie(const FrameListRequest& request, const OutputNames& names, const fs::path& file,
                       const std::optional<std::vector<int>>& frames, FrameList& list, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const std::shared_ptr<Movie> movie, Movie::open(file, request.limits, diagnostics));
  const auto add = [&](int frame) -> Result<void> {
    AFTERGLOW_TRY(FrameJob job, job_of(request, movie, frame));
    AFTERGLOW_TRY(job.output, names.numbered(file, frame + 1));
    list.jobs.push_back(std::move(job));
    return {};
  };
  if (!frames) {
    for (int frame = 0; frame < movie->frames(); ++frame) AFTERGLOW_CHECK(add(frame));
    return {};
  }
  for (const int number : *frames) {
    if (number < 1 || number > movie->frames())
      return Error{ErrorKind::io, fmt::format("has no frame {}; it has {}", number, movie->frames()), file.string()};
    AFTERGLOW_CHECK(add(number - 1));
  }
  return {};
}

/// "3, 5-7": numbers between the files that have none; empty: all are there.
std::string missing_text(const std::vector<FrameFile>& files) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::string> gaps;
  for (std::size_t i = 1; i < files.size() && gaps.size() <= kMostNamed; ++i) {
    const int first = files[i - 1].frame + 1, last = files[i].frame - 1;
    if (first <= last) gaps.push_back(first == last ? std::to_string(first) : fmt::format("{}-{}", first, last));
  }
  if (gaps.size() > kMostNamed) gaps.back() = "…";
  return join(gaps);
}

/// Of a sequence that is taken whole. `held`: its frames keep their times. Errors: usage (a video without an end).
Result<void> tell_gaps(const std::string& input, const std::vector<FrameFile>& files, bool held,
                       Diagnostics& diagnostics) {
  constexpr int kMostPlaces = 1'000'000;  // as many as a list of frames may name
  const std::string missing = missing_text(files);
  if (missing.empty()) return {};
  const int first = files.front().frame, last = files.back().frame;
  if (held && last - first >= kMostPlaces)
    return Error{ErrorKind::usage,
                 fmt::format("frames {} to {} are more than {} places of a video", first, last, kMostPlaces), input, 0,
                 "those that --frames names"};
  const bool one = missing.find_first_of(",-", 1) == std::string::npos;
  diagnostics.warn(fmt::format("{}: {} {} {} missing{}", input, one ? "frame" : "frames", missing, one ? "is" : "are",
                               !held ? ""
                               : one ? "; the one before is held"
                                     : "; those before are held"));
  return {};
}

/// `places`: frames of the video that is made of it.
SequencePart part_of(const Pattern& pattern, const std::vector<int>& frames, std::size_t places) {
  const auto all = find_frames(pattern, std::nullopt);
  if (!all || all->empty() || frames.empty()) return {};
  const auto [first, last] = std::ranges::minmax(frames);
  const bool to_the_end = last >= all->back().frame && places == static_cast<std::size_t>(last + 1 - first);
  return {std::max(first - all->front().frame, 0), to_the_end ? 0 : static_cast<int>(places)};
}

Result<void> add_files(const FrameListRequest& request, const OutputNames& names, const std::string& input,
                       const std::optional<std::vector<int>>& frames, FrameList& list, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(input));
  if (!pattern.numbered && !movie_format(pattern.file(0)).empty()) {
    const fs::path file = pattern.file(0);
    const auto added = add_movie(request, names, file, frames, list, diagnostics);
    if (added || added.error().kind != ErrorKind::io || request.inputs.size() == 1 || frames) return added;
    FrameJob job{
        .input = file, .output = names.name(file.string() + ".png", 1), .depth = {}, .normal = {}, .motion = {}};
    job.sequence = file.string();
    job.refused = added.error();
    list.jobs.push_back(std::move(job));
    return {};
  }
  if (frames && !pattern.numbered && !is_file(input)) return missing_file(input);
  if (frames && !pattern.numbered)
    return usage(fmt::format("--frames needs a numbered input like shot.####.exr or a video, not {}", input));
  LeftOut others;
  AFTERGLOW_TRY(const auto files, find_frames(pattern, frames, &others));
  others.tell(input, pattern, diagnostics);
  const bool held = names.takes_all() && request.inputs.size() == 1;
  if (pattern.numbered && !frames) AFTERGLOW_CHECK(tell_gaps(input, files, held, diagnostics));
  for (const auto& [frame, file] : files) {
    // Files that a shell has listed are frames of one sequence when they have that name in common.
    AFTERGLOW_TRY(FrameJob job, job_of(request, pattern.numbered ? input : without_frame_number(file), {frame, file}));
    job.output = names.name(file, frame);
    list.jobs.push_back(std::move(job));
  }
  if (pattern.numbered && (!frames || request.holds) && held) hold_missing(list.jobs);
  if (frames && held && !list.jobs.empty()) {
    const SequencePart part = part_of(pattern, *frames, list.jobs.size() + list.jobs.back().missing);
    for (FrameJob& job : list.jobs) job.part = part;
  }
  return {};
}

Result<void> add_standard_input(const FrameListRequest& request, const OutputNames& names,
                                const std::optional<std::vector<int>>& frames, FrameList& list,
                                Diagnostics& diagnostics) {
  if (request.inputs.size() > 1) return usage("standard input goes with no other input");
  AFTERGLOW_TRY(StandardInput input, open_standard_input(request.raw, request.limits, diagnostics));
  list.file = input.file;
  if (input.file && !movie_format(input.file->name()).empty())
    return add_movie(request, names, input.file->name(), frames, list, diagnostics);
  if (frames) return usage("--frames needs frames that can be sought in, not those of standard input");
  if (input.file) {
    AFTERGLOW_TRY(FrameJob job, job_of(request, "-", {1, input.file->name()}));
    AFTERGLOW_TRY(job.output, names.numbered("-", 1));
    list.jobs.push_back(std::move(job));
    return {};
  }
  const auto jobs = std::make_shared<StreamJobs>(request, names, std::move(input.stream));
  AFTERGLOW_TRY(std::optional<FrameJob> first, jobs->next());
  if (first) list.jobs.push_back(std::move(*first));
  list.more = [jobs] { return jobs->next(); };
  return {};
}

}  // namespace

void hold_missing(std::vector<FrameJob>& jobs) {
  for (std::size_t i = 0; i < jobs.size(); ++i)
    jobs[i].missing = static_cast<std::size_t>(jobs[i].frame - jobs.front().frame) - i;
}

Result<FrameList> list_frames(const FrameListRequest& request, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const OutputNames names, OutputNames::parse(request));
  FrameList list;
  bool standard = false;
  AFTERGLOW_TRY(const auto inputs, with_sequences(request.inputs, diagnostics));
  std::optional<std::vector<int>> frames;
  const auto choose = [&](const std::string& text) -> Result<void> {
    frames.reset();
    if (text.empty()) return {};
    AFTERGLOW_TRY(frames, parse_frames(text));
    return {};
  };
  AFTERGLOW_CHECK(choose(request.frames));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string& input = inputs[i];
    if (!request.frames_of.empty()) AFTERGLOW_CHECK(choose(request.frames_of[i]));
    if (input == "-") {
      standard = true;
      AFTERGLOW_CHECK(add_standard_input(request, names, frames, list, diagnostics));
    } else {
      AFTERGLOW_CHECK(add_files(request, names, input, frames, list, diagnostics));
    }
  }
  if (!request.raw.empty() && !standard) return usage("--raw is for frames on standard input: give - as the input");
  if (list.jobs.size() > 1 && names.one_file()) {
    for (const FrameJob& job : list.jobs)  // a word that is no picture is what was meant, not a pattern
      if (!job.movie && !frames && !is_file(job.input)) return missing_file(job.input);
    return usage(fmt::format("{} frames cannot go into the one file {}; give a pattern like out.####.png or a folder",
                             list.jobs.size(), request.output));
  }
  AFTERGLOW_CHECK(check_outputs(list.jobs, names.takes_all()));
  return list;
}

}  // namespace afterglow
