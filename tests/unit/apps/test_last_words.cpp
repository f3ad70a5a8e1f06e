#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <thread>

#include "apps/last_words.h"

namespace afterglow {
namespace {

template <class Exception>
void throw_where_nothing_may(const Exception& exception) noexcept {
  throw exception;  // NOLINT(bugprone-exception-escape): what is tested
}

TEST(LastWords, AreAnErrorAndAnExitCodeOfTheHouse) {
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(std::bad_alloc());
      },
      testing::ExitedWithCode(4), "^error: out of memory\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(std::runtime_error("why"));
      },
      testing::ExitedWithCode(1), "^error: internal error: why\n$");
  EXPECT_EXIT(
      {
        install_last_words();
        throw_where_nothing_may(1);
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
