// SPDX-License-Identifier: MIT
#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <exception>

#include "apps/command_line.h"
#include "apps/terminate_handler.h"
#include "core/result.h"

/// A standard stream that is closed leaves its number to the next file that is opened, which would then get messages
/// among its bytes. In its place stands what cannot be used either: reading 0 and writing to 1 and 2 still fail.
static void keep_standard_streams() {
  for (int file = 0; file <= 2; ++file)
    if (fcntl(file, F_GETFD) < 0 && errno == EBADF)
      static_cast<void>(open("/dev/null", file == 0 ? O_WRONLY : O_RDONLY));
}

int main(int argc, char** argv) {
  keep_standard_streams();
  afterglow::install_last_words();
  try {
    return afterglow::run_command_line(argc, argv);
  } catch (const std::exception& exception) {  // not even the message could be made
    std::fprintf(stderr, "error: %s\n", exception.what());
    return static_cast<int>(afterglow::ErrorKind::other);
  }
}
