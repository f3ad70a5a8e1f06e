// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "core/inside.h"
#include "core/process.h"
#include "farm/job.h"

namespace afterglow::farm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kJobsVersion = 1;

/// Whole, since other schedulers may start anywhere.
std::string whole_name(const Job& job, const std::filesystem::path& file) {
  return whole_path(job.at / file).string();
}

/// What frames read and write, by name.
Json files_json(const Job& job, std::span<const FrameRecord> frames) {
  std::set<std::string> inputs;
  Json outputs = Json::array();
  EarlierFiles named;  // up to where those of the frames before are in already
  for (const auto& frame : frames) {
    EarlierFiles earlier = frame.job.earlier;
    if (earlier.of == named.of && earlier.begin >= named.begin)
      earlier.begin = std::clamp(named.end, earlier.begin, earlier.end);
    for (const auto& file : earlier.files()) inputs.insert(whole_name(job, file));
    named = frame.job.earlier;
    for (const auto& file : frame.job.sources()) inputs.insert(whole_name(job, file));
    outputs.push_back(whole_name(job, frame.job.output));
  }
  return Json{{"inputs", inputs}, {"outputs", std::move(outputs)}};
}

/// What is to run when all chunks are done.
Json join_json(const Job& job, const FrameListRequest& request) {
  const auto command = job.command(job.chunks.size());
  Json inputs = Json::array();
  for (std::size_t i = 0; i < job.chunks.size(); ++i) inputs.push_back(job.piece(i).string());
  for (const auto& input : request.inputs) inputs.push_back(whole_name(job, input));
  return Json{{"after", "chunks"},
              {"command", command},
              {"shell", shell_line(command)},
              {"inputs", std::move(inputs)},
              {"outputs", Json::array({job.video})}};
}

}  // namespace

Result<std::string> jobs_text(const Job& job, const FrameListRequest& request, const std::vector<FrameJob>& frames) {
  Json out{{"afterglow_jobs", kJobsVersion},
           {"job", job.folder.string()},
           {"needs", Json{{"partition", job.needs.partition}, {"time", job.needs.time}, {"memory", job.needs.memory}}},
           {"chunks", Json::array()}};
  FrameRecords records;
  for (const auto& frame : frames) records.push_back({.job = frame});
  if (job.pre_roll) note_earlier_files(records, request, *job.pre_roll);
  const std::vector<FrameRecord> listed(records.begin(), records.end());
  std::span<const FrameRecord> left = listed;
  for (std::size_t i = 0; i < job.chunks.size(); ++i) {
    const auto count = static_cast<std::size_t>(job.chunks[i].count);
    const auto command = job.command(i);
    Json chunk{{"chunk", i},
               {"frames", job.chunks[i].frames},
               {"count", job.chunks[i].count},
               {"command", command},
               {"shell", shell_line(command)}};
    chunk.update(files_json(job, left.first(count)));
    if (!job.video.empty()) chunk["outputs"] = Json::array({job.piece(i).string()});
    left = left.subspan(count);
    out["chunks"].push_back(std::move(chunk));
  }
  if (!job.video.empty()) out["join"] = join_json(job, request);
  try {
    return out.dump(1) + "\n";
  } catch (const nlohmann::json::exception&) {
    return Error{ErrorKind::usage, "names of files must be UTF-8 for a farm", job.look};
  }
}

}  // namespace afterglow::farm
