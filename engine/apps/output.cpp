// SPDX-License-Identifier: MIT
#include "apps/output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/file.h"

namespace afterglow {
namespace {

std::FILE* g_text = stdout;  // where what people read goes
bool g_failed = false;
int g_reason = 0;  // errno of the first failure; 0: not known

void note_failure() {
  if (!g_failed) g_reason = errno;
  g_failed = true;
}

void write_to(std::FILE* stream, const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) != text.size() && stream == stdout) note_failure();
}

}  // namespace

void keep_standard_output_for(std::initializer_list<std::string_view> files) {
  if (std::ranges::find(files, "-") != files.end()) g_text = stderr;
}

void output_text(const std::string& text) { write_to(g_text, text); }

Result<void> output_file(const std::string& file, const std::string& text) {
  if (file != "-") return write_file_atomically(file, text);
  write_to(stdout, text);
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
