// SPDX-License-Identifier: MIT
#include "farm/attempt.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/environment.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/parse_number.h"
#include "core/temporary.h"
#include "core/text.h"

namespace afterglow::farm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBegun = "begun";
constexpr std::string_view kExit = "exit-";

/// Seconds since 1970.
double seconds_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

template <class Number>
bool read_number(std::string_view text, Number& out) {
  const auto number = parse_number<Number>(text);
  if (number) out = *number;
  return number.has_value();
}

std::optional<AttemptFile> attempt_of_name(const fs::path& path) {
  const auto parts = split(path.filename().string(), '.');
  AttemptFile out{.path = path};
  if (parts.size() != 3 || !read_number(parts[0], out.chunk) || !read_number(parts[1], out.number)) return std::nullopt;
  if (parts[2] == kBegun) return out;
  int code = 0;
  if (!parts[2].starts_with(kExit) || !read_number(std::string_view(parts[2]).substr(kExit.size()), code))
    return std::nullopt;
  out.exit_code = code;
  return out;
}

fs::path attempt_path(const fs::path& folder, std::size_t chunk, int number, const std::string& state) {
  return folder / fmt::format("{}.{}.{}", chunk, number, state);
}

Json begun_json(std::size_t chunk, int number) {
  return Json{{"afterglow_attempt", 1},
              {"chunk", chunk},
              {"try", number},
              {"node", node_name()},
              {"process", getpid()},
              {"task", environment("SLURM_JOB_ID")},
              {"temporaries", temporary_mark()},
              {"began", seconds_now()}};
}

/// What a try that never ended has left half-written beside the outputs.
void clean_up_after(const Job& job, const AttemptFile& attempt) {
  const auto text = read_file(attempt.path);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object() || !json.contains("temporaries") || !json["temporaries"].is_string()) return;
  const auto mark = json["temporaries"].get<std::string>();
  const fs::path outputs = job.folder.parent_path().parent_path();
  if (!mark.empty())
    for (const fs::path& folder : {outputs, outputs / ".afterglow", job.pieces()}) remove_temporaries_of(mark, folder);
}

}  // namespace

std::string node_name() {
  if (const auto name = environment("SLURMD_NODENAME"); !name.empty()) return name;
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

Result<std::vector<AttemptFile>> attempts_of(const Job& job) {
  const fs::path folder = job.folder / "attempts";
  std::vector<AttemptFile> out;
  std::error_code ec;
  fs::directory_iterator it(folder, ec);
  for (const fs::directory_iterator end; !ec && it != end; it.increment(ec))
    if (auto attempt = attempt_of_name(it->path()); attempt && attempt->chunk < job.tasks())
      out.push_back(std::move(*attempt));
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be read: {}", ec.message()), folder.string()};
  const auto place = [](const AttemptFile& a) { return std::tuple(a.chunk, a.number, !a.exit_code); };
  std::ranges::sort(out, {}, place);
  // One that ends is seen under both names by who lists the folder meanwhile: the end counts.
  const auto same = [](const AttemptFile& a, const AttemptFile& b) {
    return a.chunk == b.chunk && a.number == b.number;
  };
  out.erase(std::unique(out.begin(), out.end(), same), out.end());
  return out;
}

Result<Attempt> Attempt::begin(const Job& job, std::size_t chunk) {
  const fs::path folder = job.folder / "attempts";
  Attempt out;
  out.chunk_ = chunk;
  AFTERGLOW_TRY(const auto before, attempts_of(job));
  for (const auto& one : before) {
    if (one.chunk != chunk) continue;
    out.number_ = one.number + 1;
    if (!one.exit_code) clean_up_after(job, one);
  }
  for (;; ++out.number_) {
    out.begun_ = attempt_path(folder, chunk, out.number_, kBegun);
    const Temporary temporary(out.begun_);
    AFTERGLOW_CHECK(write_file_atomically(temporary.path(), json_text(begun_json(chunk, out.number_))));
    const bool taken = link(temporary.path().c_str(), out.begun_.c_str()) == 0;
    const int reason = errno;
    if (taken) return out;
    if (reason != EEXIST)
      return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(reason)), out.begun_.string()};
  }
}

Result<void> Attempt::end(int exit_code, const std::string& error, const std::string& report) const {
  const fs::path ended = attempt_path(begun_.parent_path(), chunk_, number_, fmt::format("{}{}", kExit, exit_code));
  AFTERGLOW_TRY(const std::string begun, read_file(begun_));
  Json json = Json::parse(begun, nullptr, false);
  if (json.is_discarded()) json = begun_json(chunk_, number_);
  json["ended"] = seconds_now();
  json["exit"] = exit_code;
  if (!error.empty()) json["error"] = error;
  if (!report.empty()) json["run"] = Json::parse(report, nullptr, false);
  // Renaming takes no room.
  const auto written = write_file_atomically(begun_, json_text(json));
  std::error_code ec;
  fs::rename(begun_, ended, ec);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be written: {}", ec.message()), ended.string()};
  return written;
}

}  // namespace afterglow::farm
