// SPDX-License-Identifier: MIT
#include "batch/inventory.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <tuple>

#include "core/file.h"
#include "core/made_shaders.h"
#include "core/parse_number.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostEvaluated = 64;  // frames, besides those that name new files; and as many of these

bool is_made(const SearchPath& path, const std::string& shader) { return path.made && path.made->find(shader); }

/// Shaders that the frame runs, and those that others may.
Result<void> add_shaders(const Preset& preset, const Graph& graph, std::set<fs::path>& files) {
  ShaderLibrary shaders(preset.path());
  for (const auto& pass : graph.passes)
    for (const auto& name : shaders_of(pass)) {
      if (is_made(preset.path(), name)) continue;
      AFTERGLOW_TRY(const auto shader, shaders.find(name));
      for (auto& file : shader->files()) files.insert(std::move(file));
    }
  if (!preset.may_change()) return {};
  for (const auto& name : shaders.names())
    if (const auto shader = shaders.find(name))
      for (auto& file : (*shader)->files()) files.insert(std::move(file));
  return {};
}

/// Asks frames one by one.
class Asking {
 public:
  Asking(Preset& preset, Inventory& out, Diagnostics& diagnostics, const EachBuild& each)
      : preset_(preset), out_(out), diagnostics_(diagnostics), each_(each) {}

  Result<void> ask(const BuildContext& frame, bool whole) {
    AFTERGLOW_TRY(const auto names, preset_.named_files(frame));
    const bool fresh = met_.insert(names).second;
    if (whole || (fresh && evaluated_++ < kMostEvaluated)) {
      AFTERGLOW_TRY(const Build build, evaluate(frame));
      return {};
    }
    // What so many frames name is not read by one process: names say where it lies.
    if (fresh)
      for (const auto& name : names)
        if (const fs::path file = preset_.path().find_asset(name); !file.empty())
          out_.depends.files.emplace(file, name);
    return {};
  }
  Result<Build> evaluate(const BuildContext& frame) {
    AFTERGLOW_TRY(Build build, preset_.evaluate(frame, diagnostics_));
    out_.depends.add(build.depends);
    if (each_) each_(build);
    return build;
  }

 private:
  Preset& preset_;
  Inventory& out_;
  Diagnostics& diagnostics_;
  const EachBuild& each_;
  std::set<std::vector<std::string>> met_;
  std::size_t evaluated_ = 0;
};

}  // namespace

Result<Inventory> take_inventory(Preset& preset, const std::vector<BuildContext>& frames, Diagnostics& diagnostics,
                                 const EachBuild& each) {
  Inventory out;
  out.sources.insert(preset.scripts().begin(), preset.scripts().end());
  out.moves = preset.may_change();
  Asking asking(preset, out, diagnostics, each);
  AFTERGLOW_TRY(const Build first,
                asking.evaluate(frames.empty() ? usual_context(preset, kUsualSize, 1, 24) : frames[0]));
  AFTERGLOW_CHECK(add_shaders(preset, first.graph, out.sources));
  const std::size_t whole = out.moves ? std::min(frames.size(), kMostEvaluated) : 0;
  for (std::size_t i = 1, next = 1; out.moves && i < frames.size(); ++i) {
    const bool is_next = next < whole && i == next * frames.size() / whole;
    if (is_next) ++next;
    AFTERGLOW_CHECK(asking.ask(frames[i], is_next));
  }
  return out;
}

std::optional<PictureHeader> first_header(const std::vector<const FrameJob*>& jobs, ReadOptions options) {
  constexpr std::size_t kMostAsked = 8;
  for (std::size_t i = 0; i < std::min(jobs.size(), kMostAsked); ++i) {
    options.movie = jobs[i]->movie;
    options.movie_frame = jobs[i]->movie_frame;
    if (jobs[i]->passing) continue;  // its header comes with its pixels
    auto header = read_header(jobs[i]->input, options);
    if (!header) continue;
    header->opened.reset();
    return std::move(header).value();
  }
  return std::nullopt;
}

std::vector<BuildContext> usual_contexts(Preset& preset, const std::vector<const FrameJob*>& jobs, double fps,
                                         const std::optional<PictureHeader>& first) {
  std::vector<BuildContext> out;
  const Size size = first ? first->data_window.size() : kUsualSize;
  for (const FrameJob* job : jobs) {
    out.push_back(usual_context(preset, size, job->frame, job->fps > 0 ? job->fps : fps));
    out.back().time = job->time.value_or(job->frame / fps);
  }
  return out;
}

Result<Hash> FileHashes::of(const fs::path& file) {
  if (const auto known = known_.find(file); known != known_.end()) return known->second;
  if (const auto seen = content_seen(*preset_.probes(), file)) return known_[file] = *seen;
  AFTERGLOW_TRY(const Hash hash, hash_file(file));
  return known_[file] = hash;
}

PortableNames::PortableNames(const SearchPath& path) : folders_(path.user) {
  folders_.push_back(path.installation);
  std::error_code ec;
  for (auto& folder : folders_) folder = folder.empty() ? folder : fs::weakly_canonical(folder, ec);
}

PortableNames::Place PortableNames::place_of(const fs::path& file) const {
  std::error_code ec;
  const fs::path whole = fs::weakly_canonical(file, ec);
  for (std::size_t i = 0; i < folders_.size(); ++i) {
    if (folders_[i].empty()) continue;
    const fs::path relative = whole.lexically_relative(folders_[i]);
    if (relative.empty() || *relative.begin() == "..") continue;
    return {i, relative.generic_string()};
  }
  return {folders_.size(), whole.generic_string()};
}

std::string PortableNames::place(const fs::path& file) const {
  const Place place = place_of(file);
  return fmt::format("{}:{}", place.folder, place.name);
}

fs::path PortableNames::file_at(const std::string& place) const {
  const std::size_t colon = std::min(place.find(':'), place.size());
  const auto folder = parse_number<std::size_t>(place.substr(0, colon));
  if (!folder || *folder > folders_.size() || colon == place.size()) return {};
  const std::string name = place.substr(colon + 1);
  return *folder == folders_.size() ? fs::path(name) : folders_[*folder] / name;
}

std::map<std::string, fs::path> PortableNames::of(const std::set<fs::path>& files) const {
  std::vector<std::tuple<std::size_t, std::string, fs::path>> places;
  for (const auto& file : files) {
    const Place place = place_of(file);
    const bool installed = place.folder + 1 == folders_.size();
    places.emplace_back(place.folder, (installed ? "installation: " : "") + place.name, file);
  }
  std::ranges::sort(places);
  // One file under two names is one.
  const auto same = [](const auto& a, const auto& b) {
    return std::get<0>(a) == std::get<0>(b) && std::get<1>(a) == std::get<1>(b);
  };
  places.erase(std::unique(places.begin(), places.end(), same), places.end());
  std::map<std::string, fs::path> out;
  for (const auto& [folder, name, file] : places)
    if (!out.emplace(name, file).second) out.emplace(fmt::format("{} (path {})", name, folder + 1), file);
  return out;
}

}  // namespace afterglow
