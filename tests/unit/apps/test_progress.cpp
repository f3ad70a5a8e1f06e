// SPDX-License-Identifier: MIT
// The line of progress on terminals of several widths.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <string>

#include "apps/console.h"

namespace afterglow {
namespace {

/// What a console says of a frame to a terminal that is so wide.
std::string line_on(unsigned short columns, const std::string& label) {
  winsize size{};
  size.ws_col = columns;
  int terminal = -1, ours = -1;
  if (openpty(&ours, &terminal, nullptr, nullptr, &size) != 0) return "no terminal";
  const int kept = dup(STDERR_FILENO);
  dup2(terminal, STDERR_FILENO);
  {
    Console console;
    console.progress(1, 4, label, 2);
    dup2(kept, STDERR_FILENO);
    close(terminal);
    close(kept);
  }
  std::string text(4096, '\0');
  const ssize_t got = read(ours, text.data(), text.size());
  close(ours);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  const std::string erase = "\r\x1b[K";
  return text.starts_with(erase) ? text.substr(erase.size()) : text;
}

TEST(Progress, StaysOnOneLineOfATerminal) {
  EXPECT_EQ(line_on(120, "shot.0001.exr"), "[======                  ] 1/4  shot.0001.exr  00:06 left");
  EXPECT_EQ(line_on(40, "shot.0001.exr"), "[======                  ] 1/4  shot.00");
  EXPECT_EQ(line_on(37, "€€€€€€"), "[======                  ] 1/4  €€€€");
  EXPECT_EQ(line_on(0, "shot.0001.exr"), "[======                  ] 1/4  shot.0001.exr  00:06 left") << "none is told";
}

}  // namespace
}  // namespace afterglow
