// SPDX-License-Identifier: MIT
#include "cli_test.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

namespace afterglow::test {

void CliTest::SetUp() {
  std::string pattern = (fs::temp_directory_path() / "afterglow-cli-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  folder_ = fs::canonical(pattern);
}

void CliTest::TearDown() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome CliTest::run(const std::vector<std::string>& arguments, RunOptions options) const {
  if (options.folder.empty()) options.folder = folder_;
  // Caches of the build folder: tests are no reason to fill the user's, and stay warm from one to the next.
  options.environment.try_emplace("AFTERGLOW_CACHE", AFTERGLOW_BUILD_FOLDER "/test-cache");
  options.environment.try_emplace("AFTERGLOW_PATH", "");
  options.environment.try_emplace("AFTERGLOW_HOME", "");
  options.environment.try_emplace("AFTERGLOW_VALIDATE", "");
  if (std::getenv("XDG_RUNTIME_DIR") == nullptr)
    options.environment.try_emplace("XDG_RUNTIME_DIR", folder_.parent_path());
  return run_program(arguments, options);
}

void CliTest::write(const std::string& name, const std::string& content) const {
  fs::create_directories(path(name).parent_path());
  std::ofstream(path(name), std::ios::binary) << content;
}

std::string CliTest::read(const std::string& name) const {
  std::stringstream content;
  content << std::ifstream(path(name), std::ios::binary).rdbuf();
  return content.str();
}

std::vector<std::string> CliTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    names.push_back(fs::relative(entry.path(), folder_).string());
  std::sort(names.begin(), names.end());
  return names;
}

void CliTest::make_exr(const std::string& name, int width, int height) const {
  OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::HALF);
  std::vector<float> pixels(static_cast<std::size_t>(width) * height * 4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool bright = x > width / 3 && x < width / 2 && y > height / 3 && y < height / 2;
      float* pixel = &pixels[(static_cast<std::size_t>(y) * width + x) * 4];
      pixel[0] = bright ? 8.0f : 0.1f;
      pixel[1] = bright ? 4.0f : 0.2f;
      pixel[2] = bright ? 2.0f : 0.3f;
      pixel[3] = 1.0f;
    }
  fs::create_directories(path(name).parent_path());
  auto out = OIIO::ImageOutput::create(text(name));
  ASSERT_TRUE(out && out->open(text(name), spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
              out->close())
      << OIIO::geterror();
}

void CliTest::make_truncated_exr(const std::string& name) const {
  make_exr(name);
  const std::string content = read(name);
  write(name, content.substr(0, content.size() / 2));
}

std::vector<float> CliTest::pixels_of(const std::string& name) const {
  auto in = OIIO::ImageInput::open(text(name));
  EXPECT_TRUE(in) << name;
  if (!in) return {};
  std::vector<float> pixels(static_cast<std::size_t>(in->spec().width) * in->spec().height * in->spec().nchannels);
  EXPECT_TRUE(in->read_image(0, 0, 0, in->spec().nchannels, OIIO::TypeDesc::FLOAT, pixels.data()));
  return pixels;
}

void CliTest::make_preset(const std::string& name) const {
  write(
      name,
      "local fx = require \"afterglow\"\nreturn fx.stack { name = \"Plain\", fx.tone_mapping { mode = \"aces\" } }\n");
}

fs::path preset(const std::string& name) { return fs::path(AFTERGLOW_PROJECT_FOLDER) / "presets" / name; }
std::string test_name_of(const ::testing::TestParamInfo<std::string>& preset) {
  std::string name = preset.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

std::vector<std::string> shipped_presets() {
  std::vector<std::string> names;
  const fs::path root = fs::path(AFTERGLOW_PROJECT_FOLDER) / "presets";
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const fs::path relative = fs::relative(entry.path(), root);
    const bool effect = relative.parent_path().filename() == "effects";
    if (relative.extension() == ".lua" && !effect) names.push_back(relative.string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path neon() { return fs::path(AFTERGLOW_TEST_FOLDER) / "images" / "neon.exr"; }

::testing::AssertionResult is_one_error_line(const std::string& text) {
  if (text.empty()) return ::testing::AssertionFailure() << "nothing on stderr";
  if (std::count(text.begin(), text.end(), '\n') != 1 || text.back() != '\n')
    return ::testing::AssertionFailure() << "not one line: " << text;
  if (text.find("error: ") == std::string::npos) return ::testing::AssertionFailure() << "no error: " << text;
  if (text.find('\x1b') != std::string::npos)
    return ::testing::AssertionFailure() << "colours without a terminal: " << text;
  return ::testing::AssertionSuccess();
}

}  // namespace afterglow::test
