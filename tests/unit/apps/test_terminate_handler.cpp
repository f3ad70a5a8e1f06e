// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <thread>

#include "apps/terminate_handler.h"

namespace afterglow {
namespace {

void throw_where_nothing_may(const std::exception_ptr& exception) noexcept {
  std::rethrow_exception(exception);  // NOLINT(bugprone-exception-escape): what is tested
}

TEST(TerminateHandler, AreAnErrorAndAnExitCodeOfTheHouse) {
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(std::make_exception_ptr(std::bad_alloc()));
      },
      testing::ExitedWithCode(4), "^error: out of memory\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        try {
          (*std::get_new_handler())();
        } catch (const std::bad_alloc&) {
        }
        std::terminate();  // as libstdc++ does without catching
      },
      testing::ExitedWithCode(4), "^error: out of memory\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(std::make_exception_ptr(std::runtime_error("why")));
      },
      testing::ExitedWithCode(1), "^error: internal error: why\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(std::make_exception_ptr(1));
      },
      testing::ExitedWithCode(1), "^error: internal error\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        std::thread forgotten([] {});
      },
      testing::ExitedWithCode(1), "^error: internal error\n$");
}

}  // namespace
}  // namespace afterglow
