// SPDX-License-Identifier: MIT
// How much memory pictures may take where nobody says it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace afterglow {

struct MemoryLimit {
  std::uint64_t bytes = 6ull << 30;
  std::string of;  ///< what it comes from, for messages; empty: it is the usual one
};

/// The usual 6 GiB, or less: what the machine has, what the process's control group (v1 or v2, as containers and batch
/// systems make them) and those above it allow. `root` holds proc/ and sys/.
MemoryLimit usual_memory_limit(const std::filesystem::path& root = "/");

/// That of this process, as it was when it was first asked for.
const MemoryLimit& memory_limit_of_process();

/// "6.1 GiB": rounded up, as what is allowed is rounded down, so that what is more reads as more.
std::string needed_memory(std::uint64_t bytes);

/// "6.0 GiB allowed (--max-memory)"; a usual limit that is less than usual says where it comes from.
std::string allowed_memory(std::uint64_t bytes);

}  // namespace afterglow
