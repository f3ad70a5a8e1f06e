#include "apps/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace afterglow {
namespace {

int g_reason = 0;  // errno of the first failure

void note_failure() {
  if (g_reason == 0) g_reason = errno != 0 ? errno : EIO;
}

}  // namespace

void output_text(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_failure();
}

Result<void> finish_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) note_failure();
  if (g_reason == 0 || g_reason == EPIPE) return {};
  return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(g_reason)), "standard output"};
}

}  // namespace afterglow
