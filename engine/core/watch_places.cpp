// SPDX-License-Identifier: MIT
#include "core/watch_places.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include <deque>
#include <system_error>

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLinks = 40;  // as the kernel

/// Steps of a path, each a name; "" behind the last '/'.
std::deque<std::string> steps_of(const fs::path& path) {
  std::deque<std::string> steps;
  for (const auto& step : path.relative_path()) steps.push_back(step.string());
  return steps;
}

}  // namespace

std::set<WatchPlace> watch_places(const fs::path& path) {
  std::set<WatchPlace> places;
  std::error_code ec;
  const fs::path whole = fs::absolute(path, ec);
  if (ec) return places;
  fs::path at = "/";
  std::deque<std::string> steps = steps_of(whole);
  for (int links = 0; !steps.empty();) {
    const std::string step = std::move(steps.front());
    steps.pop_front();
    if (step == ".") continue;
    if (step == "..") {
      at = at.parent_path();
      continue;
    }
    if (step.empty()) {  // behind the last '/'
      places.insert({at.string(), "*", true});
      break;
    }
    places.insert({at.string(), step, steps.empty()});
    const fs::path next = at / step;
    struct stat status {};
    if (lstat(next.c_str(), &status) != 0) break;
    if (!S_ISLNK(status.st_mode)) {
      at = next;
      continue;
    }
    const fs::path target = fs::read_symlink(next, ec);
    if (ec || ++links > kMostLinks) break;
    if (target.is_absolute()) at = "/";
    const auto more = steps_of(target);
    steps.insert(steps.begin(), more.begin(), more.end());
  }
  return places;
}

std::string why_unnoticed(const std::string& folder) {
  // Numbers of statfs(2); what the kernel of another machine, or a program, keeps.
  struct Kind {
    unsigned long type;
    const char* name;
  };
  static constexpr Kind kKinds[] = {
      {0x6969, "NFS"},      {0xFF534D42, "CIFS"},  {0xFE534D42, "SMB"},  {0x517B, "SMB"},      {0x65735546, "FUSE"},
      {0x01021997, "9P"},   {0x00C36400, "Ceph"},  {0x5346414F, "AFS"},  {0x6B414653, "AFS"},  {0x0BD00BD0, "Lustre"},
      {0x47504653, "GPFS"}, {0x7461636F, "OCFS2"}, {0x01161970, "GFS2"}, {0x73757245, "Coda"}, {0x786F4256, "vboxsf"}};
  struct statfs system {};
  if (statfs(folder.c_str(), &system) != 0) return {};
  const auto type = static_cast<unsigned long>(system.f_type) & 0xFFFFFFFFUL;
  for (const auto& kind : kKinds)
    if (kind.type == type) return fmt::format("{} is on a file system of type {}", folder, kind.name);
  return {};
}

}  // namespace afterglow
