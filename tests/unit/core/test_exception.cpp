// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

#include "core/exception.h"

namespace afterglow {
namespace {

TEST(Exception, SaysItOnOneLineWithoutAFullStop) {
  EXPECT_EQ(exception_text(std::runtime_error(" no such\nchunk. \n")), "no such chunk");
  EXPECT_EQ(exception_text(std::bad_alloc()), "out of memory");
}

TEST(Exception, WhatNobodyExpectsIsAnErrorOfOurs) {
  const Error unexpected = exception_error(std::logic_error("impossible"));
  EXPECT_EQ(unexpected.kind, ErrorKind::other);
  EXPECT_EQ(unexpected.message, "internal error: impossible");
  const Error memory = exception_error(std::bad_array_new_length());
  EXPECT_EQ(memory.kind, ErrorKind::io);
  EXPECT_EQ(memory.message, "out of memory");
  // What std::async throws beyond `ulimit -u`.
  const Error threads =
      exception_error(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again)));
  EXPECT_EQ(threads.kind, ErrorKind::io);
  EXPECT_EQ(threads.message, "no more threads can be started (ulimit -u or -v, or pids of the control group)");
}

}  // namespace
}  // namespace afterglow
