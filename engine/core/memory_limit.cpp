// SPDX-License-Identifier: MIT
#include "core/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

/// The number that a file holds. None: it is not there, or says "max".
std::optional<std::uint64_t> number_in(const fs::path& file) {
  std::uint64_t number = 0;
  return std::ifstream(file) >> number ? std::optional(number) : std::nullopt;
}

std::optional<std::uint64_t> memory_of_machine(const fs::path& root) {
  std::ifstream in(root / "proc/meminfo");
  std::string name, unit;
  for (std::uint64_t kib = 0; in >> name >> kib; std::getline(in, unit))
    if (name == "MemTotal:") return kib * 1024;
  return std::nullopt;
}

/// The least that a group and those above it say. In a container the groups above are out of sight, and the first that
/// is seen is its own. `group`: "/user.slice/one". (Texts: libstdc++ 12 frees parts of a path twice where there is no
/// memory for its parent.)
void hold_to_groups(const std::string& tree, std::string group, const std::string& file, MemoryLimit& limit) {
  while (group.ends_with('/')) group.pop_back();
  for (;; group.resize(std::min(group.rfind('/'), group.size() - 1))) {
    if (const auto bytes = number_in(tree + group + "/" + file); bytes && *bytes < limit.bytes)
      limit = {*bytes, fmt::format("what the control group {} may take", group.empty() ? "/" : group)};
    if (group.empty()) return;
  }
}

}  // namespace

MemoryLimit usual_memory_limit(const fs::path& root) {
  MemoryLimit limit;
  if (const auto bytes = memory_of_machine(root); bytes && *bytes < limit.bytes)
    limit = {*bytes, "what this machine has"};
  const std::string groups = (root / "sys/fs/cgroup").string();
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {  // "0::/group", "4:memory:/group"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const auto controllers = split(line.substr(first + 1, second - first - 1), ',');
    const std::string group = line.substr(second + 1);
    if (line.starts_with("0::")) hold_to_groups(groups, group, "memory.max", limit);
    if (std::ranges::find(controllers, "memory") != controllers.end())
      hold_to_groups(groups + "/memory", group, "memory.limit_in_bytes", limit);
  }
  return limit;
}

const MemoryLimit& memory_limit_of_process() {
  static const MemoryLimit limit = usual_memory_limit();
  return limit;
}

namespace {

/// As memory_text, but rounded so.
std::string rounded(std::uint64_t bytes, double (*round)(double)) {
  constexpr double kKiB = 1024, kMiB = 1024 * kKiB, kGiB = 1024 * kMiB;
  const auto value = static_cast<double>(bytes);
  if (value >= kGiB) return fmt::format("{:.1f} GiB", round(10 * (value / kGiB)) / 10);
  if (value >= kMiB) return fmt::format("{:.0f} MiB", round(value / kMiB));
  return value >= kKiB ? fmt::format("{:.0f} KiB", round(value / kKiB)) : memory_text(bytes);
}

}  // namespace

std::string needed_memory(std::uint64_t bytes) { return rounded(bytes, std::ceil); }

std::string allowed_memory(std::uint64_t bytes) {
  const MemoryLimit& usual = memory_limit_of_process();
  const std::string why = bytes == usual.bytes && !usual.of.empty() ? "; by default " + usual.of : "";
  return fmt::format("{} allowed (--max-memory{})", rounded(bytes, std::floor), why);
}

}  // namespace afterglow
