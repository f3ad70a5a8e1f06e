// SPDX-License-Identifier: MIT
#include "batch/frame_list.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <system_error>

#include "core/text.h"
#include "image/sequence.h"
#include "image/video_output.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

Error usage(std::string message) { return {ErrorKind::usage, std::move(message), "afterglow run"}; }

/// `FILE` of a --depth or --normal choice for one frame.
Result<LayerChoice> resolve(const LayerChoice& choice, int frame) {
  if (choice.file.empty()) return choice;
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(choice.file.string()));
  return LayerChoice{pattern.file(frame), choice.name};
}

/// What files that a shell has listed have in common when they are frames of one sequence. No pattern that exists.
std::string name_without_number(const fs::path& file) {
  std::string stem = file.stem().string();
  while (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem.pop_back();
  return (file.parent_path() / stem).string() + "*" + file.extension().string();
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
    if (names.is_folder_ && !fs::is_directory(request.output, ec))
      return Error{ErrorKind::io, "no such folder", request.output};
    if (!names.is_folder_) {
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

Result<void> check_outputs(const std::vector<FrameJob>& jobs, bool one) {
  std::map<fs::path, fs::path> made_from;
  for (const auto& job : jobs) {
    const auto [at, is_new] = made_from.emplace(job.output, job.input);
    if (!is_new && !one)
      return usage(fmt::format("{} and {} would both be written to {}", at->second.string(), job.input.string(),
                               job.output.string()));
    for (const auto& source : job.sources())
      if (same_file(source, job.output))
        return usage(fmt::format("{} would be overwritten by its own result", source.string()));
  }
  return {};
}

}  // namespace

bool is_one_output(const std::string& output) { return output == "-" || is_video_output(output); }

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
  return job;
}

std::vector<fs::path> FrameJob::sources() const {
  std::vector<fs::path> files{input};
  if (!depth.file.empty()) files.push_back(depth.file);
  if (!normal.file.empty()) files.push_back(normal.file);
  if (!motion.file.empty()) files.push_back(motion.file);
  return files;
}

Result<std::vector<FrameJob>> list_frames(const FrameListRequest& request) {
  std::optional<std::vector<int>> frames;
  if (!request.frames.empty()) {
    AFTERGLOW_TRY(frames, parse_frames(request.frames));
  }
  AFTERGLOW_TRY(const OutputNames names, OutputNames::parse(request));
  std::vector<FrameJob> jobs;
  for (const auto& input : request.inputs) {
    AFTERGLOW_TRY(const Pattern pattern, parse_pattern(input));
    if (frames && !pattern.numbered)
      return usage(fmt::format("--frames needs a numbered input like shot.####.exr, not {}", input));
    AFTERGLOW_TRY(const auto files, find_frames(pattern, frames));
    for (const auto& [frame, file] : files) {
      AFTERGLOW_TRY(FrameJob job, job_of(request, pattern.numbered ? input : name_without_number(file), {frame, file}));
      job.output = names.name(file, frame);
      jobs.push_back(std::move(job));
    }
  }
  if (jobs.size() > 1 && names.one_file())
    return usage(fmt::format("{} frames cannot go into the one file {}; give a pattern like out.####.png or a folder",
                             jobs.size(), request.output));
  AFTERGLOW_CHECK(check_outputs(jobs, names.takes_all()));
  return jobs;
}

}  // namespace afterglow
