// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <unistd.h>

#include <fstream>

namespace afterglow::test {

afterglow_device* ApiTest::device_ = nullptr;

testing::AssertionResult fine(afterglow_error* error) {
  const ErrorPtr owner(error);
  return error ? testing::AssertionFailure() << text_of(error) : testing::AssertionSuccess();
}

void ApiTest::SetUpTestSuite() {
  afterglow_device_options options = afterglow_device_options_default();
  options.validate = true;
  ASSERT_TRUE(fine(afterglow_device_open(&options, &device_)));
}

void ApiTest::TearDownTestSuite() {
  afterglow_text* text = nullptr;
  ASSERT_TRUE(fine(afterglow_device_describe(device_, &text)));
  const auto told = nlohmann::json::parse(str(afterglow_text_get(text)));
  EXPECT_EQ(told["validation_errors"], 0) << told["validation_messages"].dump(2);
  afterglow_text_free(text);
  afterglow_device_free(device_);
  device_ = nullptr;
}

void ApiTest::SetUp() {
  folder_ = fs::path(testing::TempDir()) / (std::string("afterglow_api_") + std::to_string(getpid()) + "_" +
                                            testing::UnitTest::GetInstance()->current_test_info()->name());
  fs::remove_all(folder_);
  write("effects/gain.lua", R"(
    local fx = require "afterglow"
    return fx.effect {
      name = "gain", doc = "Multiplies.", at = "post_process", order = 10,
      settings = { amount = fx.float { default = 1, min = 0, max = 1e6, unit = "times", doc = "Factor." },
                   tint = fx.color { default = {1, 1, 1}, doc = "Colour." },
                   off = fx.bool { default = false, doc = "Does nothing." },
                   way = fx.enum { "once", "twice", default = "once", doc = "How often." } },
      active = function(s) return not s.off, "off is set" end,
      build = function(g, s, source)
        local amount = s.way == "twice" and s.amount * s.amount or s.amount
        return g:pass { shader = "gain/gain", source = source, amount = amount, tint = s.tint }
      end,
    })");
  write("shaders/gain/gain.glsl",
        "uniform float amount;\nuniform vec3 tint;\n"
        "vec4 apply(vec4 color) { return vec4(color.rgb * amount * tint, color.a); }\n");
  write("effects/fog.lua", R"(
    local fx = require "afterglow"
    return fx.effect {
      name = "fog", doc = "Shows depth.", at = "before_post_process", order = 0, needs = { "depth" }, settings = {},
      build = function(g, s, source)
        return g:pass { shader = "gain/fog", source = source, depth = g:input("depth") }
      end,
    })");
  write("shaders/gain/fog.glsl",
        "uniform sampler2D source;\nuniform sampler2D depth;\n"
        "vec4 sample_at(ivec2 pixel) { vec4 c = fetch(source, pixel); c.rgb += fetch(depth, pixel).r; return c; }\n");
  look("fx.gain { amount = 2 }");
}

void ApiTest::TearDown() { fs::remove_all(folder_); }

void ApiTest::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name) << text;
}

void ApiTest::look(const std::string& entries) const {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + entries + " }\n");
}

StackPtr ApiTest::stack(afterglow_stack_options options) const {
  const std::string look = file("look.lua");
  if (!options.preset_file.data && !options.preset_text.data) options.preset_file = str(look);
  afterglow_stack* out = nullptr;
  EXPECT_TRUE(fine(afterglow_stack_create(device_, &options, &out)));
  return StackPtr(out);
}

ErrorPtr ApiTest::broken(afterglow_stack_options options) const {
  const std::string look = file("look.lua");
  if (!options.preset_file.data && !options.preset_text.data) options.preset_file = str(look);
  afterglow_stack* out = nullptr;
  ErrorPtr error(afterglow_stack_create(device_, &options, &out));
  EXPECT_TRUE(error);
  EXPECT_EQ(out, nullptr);
  return error;
}

std::vector<float> ApiTest::pixels(int width, int height) {
  std::vector<float> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = i % 4 == 3 ? static_cast<float>(i % 7) / 6 : static_cast<float>(i * 37 % 101) / 32;
  return out;
}

afterglow_image ApiTest::image(std::vector<float>& pixels, int width, int height, int channels) {
  return {pixels.data(), width, height, channels, AFTERGLOW_FLOAT, 0, 0};
}

afterglow_stack_options ApiTest::listening() {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.user = &messages_;
  options.message = [](void* user, afterglow_severity, afterglow_string message) {
    static_cast<std::vector<std::string>*>(user)->push_back(str(message));
  };
  return options;
}

}  // namespace afterglow::test
