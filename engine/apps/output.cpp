// SPDX-License-Identifier: MIT
#include "apps/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/file.h"

namespace afterglow {
namespace {

bool g_failed = false;
int g_reason = 0;  // errno of the first failure; 0: not known

void note_failure() {
  if (!g_failed) g_reason = errno;
  g_failed = true;
}

}  // namespace

void output_text(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_failure();
}

Result<void> output_file(const std::string& file, const std::string& text) {
  if (file != "-") return write_file_atomically(file, text);
  output_text(text);
  return {};
}

Result<void> finish_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) note_failure();
  if (!g_failed || g_reason == EPIPE) return {};
  const std::string reason = g_reason != 0 ? std::string(": ") + std::strerror(g_reason) : std::string();
  return Error{ErrorKind::io, "cannot be written" + reason, "standard output"};
}

}  // namespace afterglow
