// SPDX-License-Identifier: MIT
// What tests of the C interface share: a device, a folder with effects, and errors that end a test.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "afterglow.h"

namespace afterglow::test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct FreeError {
  void operator()(afterglow_error* error) const { afterglow_error_free(error); }
};
struct FreeStack {
  void operator()(afterglow_stack* stack) const { afterglow_stack_free(stack); }
};
using ErrorPtr = std::unique_ptr<afterglow_error, FreeError>;
using StackPtr = std::unique_ptr<afterglow_stack, FreeStack>;

inline std::string str(afterglow_string view) { return {view.data, view.size}; }
inline afterglow_string str(const std::string& text) { return {text.data(), text.size()}; }
inline afterglow_string str(const char* text) { return {text, std::strlen(text)}; }  ///< a literal, which stays
inline std::string text_of(const afterglow_error* error) { return str(afterglow_error_get_text(error)); }

/// No error; else its text is the failure's.
testing::AssertionResult fine(afterglow_error* error);

/// What a function that hands a text over says.
template <class Function>
nlohmann::json json_of(Function function, const afterglow_stack* stack) {
  afterglow_text* text = nullptr;
  EXPECT_TRUE(fine(function(stack, &text)));
  const auto parsed = nlohmann::json::parse(str(afterglow_text_get(text)), nullptr, false);
  afterglow_text_free(text);
  EXPECT_FALSE(parsed.is_discarded());
  return parsed;
}

class ApiTest : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;
  void TearDown() override;

  void write(const std::string& name, const std::string& text) const;
  /// look.lua with these entries.
  void look(const std::string& entries) const;
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Of look.lua, unless the options name another preset.
  StackPtr stack(afterglow_stack_options options = afterglow_stack_options_default()) const;
  /// Like `stack`, where that cannot be.
  ErrorPtr broken(afterglow_stack_options options = afterglow_stack_options_default()) const;

  /// RGBA floats that have something of everything.
  static std::vector<float> pixels(int width, int height);
  static afterglow_image image(std::vector<float>& pixels, int width, int height, int channels = 4);

  static afterglow_device* device_;
  fs::path folder_;
  /// What the library has said to stacks made with `listening`.
  std::vector<std::string> messages_;
  afterglow_stack_options listening();
};

}  // namespace afterglow::test
