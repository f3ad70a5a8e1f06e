// SPDX-License-Identifier: MIT
// What the shared library shows of itself, and what it asks for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "program.h"

namespace afterglow::test {
namespace {
using ::testing::HasSubstr;
using ::testing::Not;

std::string output_of(const char* program, const std::vector<std::string>& arguments) {
  RunOptions options;
  options.folder = testing::TempDir();
  options.program = program;
  const Outcome outcome = run_program(arguments, options);
  EXPECT_EQ(outcome.exit_code, 0) << program << ": " << outcome.err;
  return outcome.out;
}

std::string header() {
  std::ifstream file(AFTERGLOW_PROJECT_FOLDER "/engine/api/afterglow.h");
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Library, ShowsTheFunctionsOfItsHeaderAndNothingElse) {
  const std::string text = header();
  std::set<std::string> declared, shown;
  const std::regex declaration(R"(AFTERGLOW_API[^;(]*\b(afterglow_\w+)\()");
  for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it) declared.insert((*it)[1]);
  ASSERT_GT(declared.size(), 30u);
  std::istringstream lines(output_of("/usr/bin/nm", {"-D", "--defined-only", "--format=posix", AFTERGLOW_LIBRARY}));
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find(' '));
    // Of the sanitizers' runtime, where there is one.
    if (name.starts_with("__asan") || name.starts_with("__odr_asan") || name.starts_with("__lsan")) continue;
    shown.insert(name);
  }
  EXPECT_EQ(shown, declared);
}

TEST(Library, AsksForNoFunctionOfVulkan) {
  std::istringstream lines(output_of("/usr/bin/nm", {"-D", "--undefined-only", "--format=posix", AFTERGLOW_LIBRARY}));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_FALSE(line.starts_with("vk")) << line;
  EXPECT_GT(count, 100u);
}

TEST(Library, HasASonameAndNeedsNoVulkan) {
  const std::string dynamic = output_of("/usr/bin/readelf", {"-d", "-W", AFTERGLOW_LIBRARY});
  EXPECT_THAT(dynamic, HasSubstr("Library soname: [libafterglow.so.0]"));
  EXPECT_THAT(dynamic, Not(HasSubstr("libvulkan")));
  EXPECT_THAT(dynamic, Not(HasSubstr("libOpenImageIO")));
}

}  // namespace
}  // namespace afterglow::test
