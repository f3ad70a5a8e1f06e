// SPDX-License-Identifier: MIT
// Whole pictures: the program runs each case and the result is compared with the picture beside it.
//
// case.json: { "preset": …, "input": …, "output": "png"|"exr", "arguments": […], "fail": t, "fail_fraction": f,
// "hard_fail": h } Paths are relative to the project. A case passes when at most the fraction f of the samples differs
// by more than t, and none by more than h (absolute differences of the stored values). After a wanted change:
// AFTERGLOW_UPDATE=1 ctest -R Golden, then look at the pictures.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace {
namespace fs = std::filesystem;
using OIIO::ImageBuf;

const fs::path kProject = AFTERGLOW_PROJECT_FOLDER;
const fs::path kGolden = fs::path(AFTERGLOW_TEST_FOLDER) / "golden";

struct Case {
  std::string name, preset, input, output;
  std::vector<std::string> arguments;
  float fail, hard_fail;
  double fail_fraction;
};

Case read_case(const fs::path& folder) {
  const auto json = nlohmann::json::parse(std::ifstream(folder / "case.json"));
  return {folder.filename(),
          json.at("preset"),
          json.at("input"),
          json.at("output"),
          json.value("arguments", std::vector<std::string>{}),
          json.at("fail"),
          json.at("hard_fail"),
          json.at("fail_fraction")};
}

std::vector<Case> cases() {
  std::vector<Case> found;
  for (const auto& entry : fs::directory_iterator(kGolden))
    if (fs::exists(entry.path() / "case.json")) found.push_back(read_case(entry.path()));
  std::sort(found.begin(), found.end(), [](const Case& a, const Case& b) { return a.name < b.name; });
  return found;
}

int run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    setenv("AFTERGLOW_HOME", kProject.c_str(), 1);
    setenv("AFTERGLOW_VALIDATE", "1", 1);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class Golden : public testing::TestWithParam<Case> {};

TEST_P(Golden, PictureIsAsExpected) {
  const Case& c = GetParam();
  const fs::path expected = kGolden / c.name / ("expected." + c.output);
  const fs::path made =
      fs::temp_directory_path() / ("afterglow_golden_" + c.name + "_" + std::to_string(getpid()) + "." + c.output);
  std::vector<std::string> words{AFTERGLOW_PROGRAM, "run", kProject / c.preset, kProject / c.input, "-o", made, "-q",
                                 "--dither",        "none"};
  // Files among them are the project's.
  for (const auto& word : c.arguments)
    words.push_back(fs::is_regular_file(kProject / word) ? (kProject / word).string() : word);
  ASSERT_EQ(run(words), 0);
  if (std::getenv("AFTERGLOW_UPDATE")) fs::copy_file(made, expected, fs::copy_options::overwrite_existing);

  ImageBuf a(made.string()), b(expected.string());
  ASSERT_TRUE(a.read()) << a.geterror();
  ASSERT_TRUE(b.read()) << b.geterror();
  ASSERT_EQ(a.spec().width, b.spec().width);
  ASSERT_EQ(a.spec().height, b.spec().height);
  ASSERT_EQ(a.nchannels(), b.nchannels());
  const auto result = OIIO::ImageBufAlgo::compare(a, b, c.fail, c.fail);
  const double samples = double(a.spec().width) * a.spec().height;
  EXPECT_LE(result.nfail / samples, c.fail_fraction) << "see " << made;
  EXPECT_LE(result.maxerror, c.hard_fail) << "at " << result.maxx << "," << result.maxy << "; see " << made;
  if (!HasFailure()) fs::remove(made);
}

INSTANTIATE_TEST_SUITE_P(Cases, Golden, testing::ValuesIn(cases()), [](const auto& info) { return info.param.name; });

}  // namespace
