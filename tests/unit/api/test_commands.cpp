// SPDX-License-Identifier: MIT
// Recording: what is refused before there is anything to record. examples/vulkan.c records.
#include "fixture.h"

namespace afterglow::test {
namespace {

class CommandsTest : public ApiTest {
 protected:
  static afterglow_stack_options recording() {
    afterglow_stack_options options = afterglow_stack_options_default();
    options.use = AFTERGLOW_USE_COMMANDS;
    return options;
  }
  static afterglow_shape shape() {
    afterglow_shape out = afterglow_shape_default();
    out.width = 8;
    out.height = 4;
    return out;
  }
};

TEST_F(CommandsTest, TheOrderOfCallsIsKept) {
  const StackPtr stack = this->stack(recording());
  auto* commands = reinterpret_cast<VkCommandBuffer>(1);  // never reached
  const ErrorPtr early(afterglow_stack_record(stack.get(), commands));
  EXPECT_THAT(text_of(early.get()), HasSubstr("afterglow_stack_prepare first"));
  const afterglow_bindings nothing = afterglow_bindings_default();
  const ErrorPtr bound_early(afterglow_stack_bind(stack.get(), &nothing));
  EXPECT_EQ(afterglow_error_get_kind(bound_early.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_THAT(text_of(bound_early.get()), HasSubstr("afterglow_stack_prepare first"));
  const afterglow_shape wanted = shape();
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  EXPECT_TRUE(afterglow_stack_runs(stack.get()));
  const ErrorPtr unbound(afterglow_stack_record(stack.get(), commands));
  EXPECT_THAT(text_of(unbound.get()), HasSubstr("afterglow_stack_bind first"));
  EXPECT_TRUE(ErrorPtr(afterglow_stack_bind(stack.get(), &nothing)));
  EXPECT_EQ(afterglow_error_get_kind(ErrorPtr(afterglow_stack_record(stack.get(), nullptr)).get()),
            AFTERGLOW_ERROR_USAGE);
}

/// Also where effects look back: their programs are given images of histories, which are not the caller's.
TEST_F(CommandsTest, WhatIsNewWantsToBeBound) {
  look("fx.auto_exposure { enabled = false }");
  const StackPtr stack = this->stack(recording());
  const afterglow_shape wanted = shape();
  const afterglow_bindings nothing = afterglow_bindings_default();
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  ASSERT_TRUE(fine(afterglow_stack_bind(stack.get(), &nothing))) << "nothing runs";
  ASSERT_TRUE(fine(afterglow_stack_set_boolean(stack.get(), str("auto_exposure.enabled"), true)));
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  EXPECT_TRUE(afterglow_stack_runs(stack.get()));
  const ErrorPtr unbound(afterglow_stack_record(stack.get(), reinterpret_cast<VkCommandBuffer>(1)));
  EXPECT_EQ(afterglow_error_get_kind(unbound.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_THAT(text_of(unbound.get()), HasSubstr("afterglow_stack_bind first"));
}

TEST_F(CommandsTest, WhatIsPreparedOutlastsFailures) {
  look("fx.fog { required = true }, fx.fog {}");
  afterglow_stack_options options = recording();
  options.max_memory = 1 << 20;
  const StackPtr stack = this->stack(options);
  afterglow_shape wanted = shape();
  wanted.depth = true;
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  EXPECT_TRUE(afterglow_stack_runs(stack.get()));

  look("fx.fog {");
  EXPECT_TRUE(ErrorPtr(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_TRUE(ErrorPtr(afterglow_stack_set_number(stack.get(), str("fog.amount"), 1)));
  wanted.depth = false;
  const ErrorPtr required(afterglow_stack_prepare(stack.get(), &wanted, nullptr));
  EXPECT_THAT(text_of(required.get()), HasSubstr("no depth input"));
  EXPECT_TRUE(ErrorPtr(afterglow_stack_prepare(stack.get(), nullptr, nullptr)));
  EXPECT_TRUE(afterglow_stack_runs(stack.get()));
  const ErrorPtr unbound(afterglow_stack_record(stack.get(), reinterpret_cast<VkCommandBuffer>(1)));
  EXPECT_THAT(text_of(unbound.get()), HasSubstr("afterglow_stack_bind first"));

  // What does not fit the device's memory takes the place of what was there all the same.
  wanted = shape();
  wanted.depth = true;
  wanted.width = wanted.height = 2048;
  const ErrorPtr large(afterglow_stack_prepare(stack.get(), &wanted, nullptr));
  EXPECT_EQ(afterglow_error_get_kind(large.get()), AFTERGLOW_ERROR_IO);
  EXPECT_FALSE(afterglow_stack_runs(stack.get()));

  look("fx.gain { amount = 2 }");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  wanted = shape();
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_FALSE(afterglow_stack_runs(stack.get())) << "another stack wants to be prepared";
}

TEST_F(CommandsTest, ImagesThatCannotBeReadAreRefused) {
  const StackPtr stack = this->stack(recording());
  const afterglow_shape wanted = shape();
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  const auto image = [&](std::uintptr_t handle, VkFormat format) {  // never looked at
    return afterglow_vulkan_image{reinterpret_cast<VkImage>(handle), reinterpret_cast<VkImageView>(handle), format,
                                  static_cast<std::uint32_t>(wanted.width), static_cast<std::uint32_t>(wanted.height)};
  };
  const auto refused = [&](VkFormat format, std::uintptr_t handle, const char* told) {
    afterglow_bindings bindings = afterglow_bindings_default();
    bindings.source = image(handle, format);
    bindings.result = image(2, afterglow_stack_result_format(stack.get()));
    const ErrorPtr error(afterglow_stack_bind(stack.get(), &bindings));
    EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE);
    EXPECT_THAT(text_of(error.get()), HasSubstr(told)) << format;
  };
  refused(VK_FORMAT_UNDEFINED, 1, "source has the format VK_FORMAT_UNDEFINED");
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_R32G32B32A32_SINT, VK_FORMAT_R16_UINT})
    refused(format, 1, "source has a format of integers");
  refused(VK_FORMAT_R32G32B32A32_SFLOAT, 2, "source is the image of the result");
}

TEST_F(CommandsTest, AStackIsForOneUse) {
  const StackPtr memory = this->stack();
  const afterglow_bindings bindings = afterglow_bindings_default();
  EXPECT_EQ(afterglow_error_get_kind(ErrorPtr(afterglow_stack_bind(memory.get(), &bindings)).get()),
            AFTERGLOW_ERROR_USAGE);
  const StackPtr commands = this->stack(recording());
  const afterglow_run_info info = afterglow_run_info_default();
  const ErrorPtr run(afterglow_stack_run(commands.get(), &info));
  EXPECT_THAT(text_of(run.get()), HasSubstr("afterglow_stack_record"));
}

TEST_F(CommandsTest, TheResultsFormatIsTold) {
  afterglow_stack_options options = recording();
  options.precision = AFTERGLOW_PRECISION_FP16;
  const StackPtr halves = this->stack(options);
  afterglow_shape wanted = shape();
  ASSERT_TRUE(fine(afterglow_stack_prepare(halves.get(), &wanted, nullptr)));
  EXPECT_EQ(afterglow_stack_result_format(halves.get()), VK_FORMAT_R16G16B16A16_SFLOAT);
  const StackPtr codes = this->stack(recording());
  wanted.display_codes = true;
  ASSERT_TRUE(fine(afterglow_stack_prepare(codes.get(), &wanted, nullptr)));
  EXPECT_EQ(afterglow_stack_result_format(codes.get()), VK_FORMAT_R8G8B8A8_UNORM);
}

/// Whoever switches the last effect off still has codes.
TEST_F(CommandsTest, CodesAreMadeWhereNoEffectRuns) {
  look("fx.gain { off = true }");
  const StackPtr stack = this->stack(recording());
  afterglow_shape wanted = shape();
  ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
  EXPECT_FALSE(afterglow_stack_runs(stack.get()));
  wanted.display_codes = true;
  for (const bool straight : {false, true})
    for (const bool dither : {false, true}) {
      wanted.straight_alpha = straight;
      wanted.dither = dither;
      ASSERT_TRUE(fine(afterglow_stack_prepare(stack.get(), &wanted, nullptr)));
      EXPECT_TRUE(afterglow_stack_runs(stack.get()));
      EXPECT_EQ(afterglow_stack_result_format(stack.get()), VK_FORMAT_R8G8B8A8_UNORM);
    }
}

TEST_F(CommandsTest, AdoptedDevicesAreChecked) {
  afterglow_device* device = nullptr;
  const afterglow_adopted_device nothing = afterglow_adopted_device_default();
  const ErrorPtr error(afterglow_device_adopt(&nothing, &device));
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_THAT(text_of(error.get()), HasSubstr("afterglow_adopted_device: instance is NULL"));
  EXPECT_EQ(device, nullptr);
}

}  // namespace
}  // namespace afterglow::test
