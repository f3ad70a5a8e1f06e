// SPDX-License-Identifier: MIT
#include "farm/job.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/file.h"
#include "core/hash.h"
#include "core/inside.h"

namespace afterglow::farm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kVersion = 2;
constexpr std::size_t kLargest = 512u << 20;  // a million single files are named one by one

Json chunk_json(const Chunk& chunk) {
  return Json{{"inputs", chunk.inputs}, {"frames", chunk.frames}, {"count", chunk.count}};
}

Chunk chunk_of(const Json& json) {
  return {json.at("inputs").get<std::vector<std::string>>(), json.at("frames").get<std::string>(),
          json.at("count").get<int>()};
}

Json needs_json(const Needs& needs) {
  return Json{{"partition", needs.partition},
              {"time", needs.time},
              {"memory", needs.memory},
              {"retries", needs.retries},
              {"more", needs.more}};
}

Needs needs_of(const Json& json) {
  return {json.at("partition").get<std::string>(), json.at("time").get<std::string>(),
          json.at("memory").get<std::string>(), json.at("retries").get<int>(),
          json.at("more").get<std::vector<std::string>>()};
}

Json job_json(const Job& job) {
  Json out{{"afterglow_farm", kVersion},
           {"id", job.id},
           {"afterglow", job.version},
           {"program", job.program},
           {"at", job.at.string()},
           {"look", job.look},
           {"run", job.run},
           {"environment", job.environment},
           {"files", job.files},
           {"pre_roll", job.pre_roll ? Json(*job.pre_roll) : Json(nullptr)},
           {"needs", needs_json(job.needs)},
           {"video", job.video},
           {"holds_missing", job.holds_missing},
           {"chunks", Json::array()}};
  for (const auto& chunk : job.chunks) out["chunks"].push_back(chunk_json(chunk));
  return out;
}

Job job_of_json(const Json& json) {
  Job job;
  job.id = json.at("id").get<std::string>();
  job.version = json.at("afterglow").get<std::string>();
  job.program = json.at("program").get<std::string>();
  job.at = json.at("at").get<std::string>();
  job.look = json.at("look").get<std::string>();
  job.run = json.at("run").get<std::vector<std::string>>();
  job.environment = json.at("environment").get<std::map<std::string, std::string>>();
  job.files = json.at("files").get<std::map<std::string, std::string>>();
  if (!json.at("pre_roll").is_null()) job.pre_roll = json.at("pre_roll").get<int>();
  job.needs = needs_of(json.at("needs"));
  job.video = json.at("video").get<std::string>();
  job.holds_missing = json.value("holds_missing", false);
  for (const auto& chunk : json.at("chunks")) job.chunks.push_back(chunk_of(chunk));
  for (const auto& chunk : job.chunks)
    if (chunk.count < 1) throw std::invalid_argument("a chunk without frames");
  return job;
}

Error not_a_job(const fs::path& file, const std::string& why) {
  return {ErrorKind::io, fmt::format("this is no farm job: {}", why), file.string(), 0,
          "a folder that `afterglow farm` made"};
}

/// The newest job of a folder of outputs; empty: there is none.
fs::path latest_job(const fs::path& outputs) {
  const auto folders = job_folders(outputs);
  return folders.empty() ? fs::path() : folders.back();
}

}  // namespace

std::size_t Job::frames() const {
  std::size_t sum = 0;
  for (const auto& chunk : chunks) sum += static_cast<std::size_t>(chunk.count);
  return sum;
}

std::vector<std::string> Job::command(std::size_t task) const {
  if (is_join(task)) return {program, "farm", "join", folder.string()};
  return {program, "farm", "chunk", folder.string(), fmt::format("{}", task)};
}

fs::path Job::piece(std::size_t chunk) const {
  return pieces() / fmt::format("{}{}", chunk, fs::path(video).extension().string());
}

std::vector<Chunk> Job::inputs() const {
  std::vector<Chunk> out;
  for (const Chunk& chunk : chunks) {
    const bool goes_on =
        !out.empty() && !chunk.frames.empty() && !out.back().frames.empty() && out.back().inputs == chunk.inputs;
    if (!goes_on) {
      out.push_back(chunk);
      continue;
    }
    out.back().frames += "," + chunk.frames;
    out.back().count += chunk.count;
  }
  return out;
}

std::vector<Chunk> chunks_of(const std::vector<FrameJob>& jobs, int most) {
  std::vector<Chunk> chunks;
  const auto is_sequence = [](const FrameJob& job) {
    if (job.movie) return true;
    const auto pattern = parse_pattern(job.sequence);
    return pattern && pattern->numbered;
  };
  const auto size = static_cast<std::size_t>(most);
  for (std::size_t i = 0; i < jobs.size();) {
    const bool numbered = is_sequence(jobs[i]);
    Chunk chunk;
    std::vector<int> frames;
    std::size_t end = i;
    for (; end < jobs.size() && end - i < size; ++end) {
      if (is_sequence(jobs[end]) != numbered || (numbered && jobs[end].sequence != jobs[i].sequence)) break;
      if (numbered)
        frames.push_back(jobs[end].frame);
      else
        chunk.inputs.push_back(jobs[end].input.string());
    }
    if (numbered) chunk.inputs.push_back(jobs[i].sequence);
    chunk.frames = frames_text(frames);
    chunk.count = static_cast<int>(end - i);
    chunks.push_back(std::move(chunk));
    i = end;
  }
  return chunks;
}

std::string new_job_id() {
  using std::chrono::duration_cast, std::chrono::milliseconds;
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  const auto ms = duration_cast<milliseconds>(since).count();
  const auto now = static_cast<std::time_t>(ms / 1000);
  std::tm utc{};
  gmtime_r(&now, &utc);
  const std::string mark = Hasher()
                               .add(static_cast<std::uint64_t>(since.count()))
                               .add(static_cast<std::uint64_t>(getpid()))
                               .finish()
                               .hex()
                               .substr(0, 4);
  return fmt::format("{:04}{:02}{:02}-{:02}{:02}{:02}-{:03}-{}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec, ms % 1000, mark);
}

Result<fs::path> make_job_folder(const fs::path& outputs) {
  std::error_code ec;
  const fs::path above = whole_path(outputs.empty() ? "." : outputs) / kFolder;
  fs::create_directory(above, ec);
  while (!ec) {
    const fs::path folder = above / new_job_id();
    if (!fs::create_directory(folder, ec)) continue;  // somebody else's, made in the same moment
    for (const char* name : {"look", "attempts", "logs", "pieces"})
      if (!ec) fs::create_directory(folder / name, ec);
    if (!ec) return folder;
  }
  return Error{ErrorKind::io, fmt::format("cannot be made: {}", ec.message()), above.string()};
}

Result<void> write_job(const Job& job) {
  try {
    return write_file_atomically(job.folder / "job.json", job_json(job).dump(1) + "\n");
  } catch (const nlohmann::json::exception&) {
    return Error{ErrorKind::usage, "names of files must be UTF-8 for a farm", job.look};
  }
}

Result<Job> read_job(const fs::path& folder) {
  const fs::path file = folder / "job.json";
  AFTERGLOW_TRY(const std::string text, read_file(file, kLargest));
  try {
    const Json json = Json::parse(text);
    const int version = json.at("afterglow_farm").get<int>();
    if (version != kVersion)
      return not_a_job(file, fmt::format("it has version {}, this program reads version {}", version, kVersion));
    Job job = job_of_json(json);
    job.folder = whole_path(folder);
    return job;
  } catch (const std::exception& error) {
    return not_a_job(file, error.what());
  }
}

std::vector<fs::path> job_folders(const fs::path& outputs) {
  std::vector<fs::path> folders;
  std::error_code ec;
  for (fs::directory_iterator it(outputs / kFolder, ec), end; !ec && it != end; it.increment(ec))
    if (is_file(it->path() / "job.json")) folders.push_back(it->path());
  std::ranges::sort(folders);
  return folders;
}

Result<Job> find_job(const std::string& given) {
  const fs::path path = given.empty() ? "." : given;
  for (const fs::path& folder : {path, fs::path(kFolder) / path, latest_job(path)})
    if (!folder.empty() && is_file(folder / "job.json")) return read_job(folder);
  return Error{ErrorKind::io, "there is no farm job", path.string(), 0,
               "a job's folder as `afterglow farm` printed it, or the folder of its outputs"};
}

void discard_job(const Job& job) {
  std::error_code ec;
  fs::remove_all(job.folder, ec);
  fs::remove(job.folder.parent_path(), ec);  // unless another job lies there
}

Result<void> check_packed(const Job& job) {
  constexpr std::string_view kLock = "--locked=";
  for (const std::string& word : job.run) {
    if (!word.starts_with(kLock)) continue;
    const fs::path lock = word.substr(kLock.size()), made = lock.parent_path().parent_path();
    if (is_file(lock) || made == job.folder) continue;
    return Error{ErrorKind::io, "the job's folder was moved here; move it back, or submit the job anew",
                 job.folder.string(), 0, made.string()};
  }
  for (const auto& [name, hash] : job.files) {
    const fs::path file = job.folder / name;
    AFTERGLOW_TRY(const Hash now, hash_file(file));
    if (now.hex() != hash)
      return Error{ErrorKind::io, "has changed since the job was submitted; submit it again", file.string()};
  }
  return {};
}

}  // namespace afterglow::farm
