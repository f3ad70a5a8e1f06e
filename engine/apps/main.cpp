// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>

#include "apps/command_line.h"
#include "apps/terminate_handler.h"
#include "core/result.h"

int main(int argc, char** argv) {
  afterglow::install_last_words();
  try {
    return afterglow::run_command_line(argc, argv);
  } catch (const std::exception& exception) {  // not even the message could be made
    std::fprintf(stderr, "error: %s\n", exception.what());
    return static_cast<int>(afterglow::ErrorKind::other);
  }
}
