// SPDX-License-Identifier: MIT
// Errors as objects, structures of other versions, arguments that are not there.
#include "fixture.h"

namespace afterglow::test {
namespace {

class ErrorTest : public ApiTest {
 protected:
  StackPtr prepared(const afterglow_stack_options& options) const {
    StackPtr out = stack(options);
    afterglow_shape shape = afterglow_shape_default();
    shape.width = shape.height = 4;
    EXPECT_TRUE(fine(afterglow_stack_prepare(out.get(), &shape, nullptr)));
    return out;
  }
};

TEST_F(ErrorTest, NamesKindFileLineAllowedAndNearest) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.gain { amonut = 2 },\n}\n");
  const ErrorPtr error = broken();
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_SCRIPT);
  EXPECT_EQ(str(afterglow_error_get_file(error.get())), file("look.lua"));
  EXPECT_EQ(afterglow_error_get_line(error.get()), 3);
  EXPECT_THAT(str(afterglow_error_get_message(error.get())), HasSubstr("has no setting 'amonut'"));
  EXPECT_THAT(str(afterglow_error_get_allowed(error.get())), HasSubstr("tint"));
  EXPECT_EQ(str(afterglow_error_get_nearest(error.get())), "amount");
  EXPECT_THAT(text_of(error.get()), HasSubstr("look.lua:3: error: "));
  EXPECT_THAT(text_of(error.get()), HasSubstr("did you mean 'amount'?"));
}

TEST_F(ErrorTest, NothingIsNoError) {
  EXPECT_EQ(afterglow_error_get_kind(nullptr), AFTERGLOW_ERROR_NONE);
  EXPECT_EQ(str(afterglow_error_get_text(nullptr)), "");
  EXPECT_EQ(afterglow_error_get_line(nullptr), 0);
  afterglow_error_free(nullptr);
  EXPECT_EQ(str(afterglow_text_get(nullptr)), "");
  afterglow_text_free(nullptr);
  afterglow_device_free(nullptr);
  afterglow_stack_free(nullptr);
  EXPECT_FALSE(afterglow_stack_runs(nullptr));
}

/// The system would end the name there, and take another file.
TEST_F(ErrorTest, NamesOfFilesHaveNoNulInThem) {
  const auto refused = [](afterglow_error* given) {
    const ErrorPtr error(given);
    return afterglow_error_get_kind(error.get()) == AFTERGLOW_ERROR_USAGE &&
           text_of(error.get()).find("embedded NUL in the name of a file") != std::string::npos;
  };
  write("table.cube", "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n");
  using Options = afterglow_stack_options;
  const std::string name = file("look.lua") + '\0' + "x";
  const afterglow_string nul = str(name);
  for (const auto member : {&Options::preset_file, &Options::installation, &Options::calibration}) {
    Options options = afterglow_stack_options_default();
    options.preset_file = str("neon_night");
    options.*member = nul;
    EXPECT_TRUE(refused(broken(options).release()));
  }
  Options options = afterglow_stack_options_default();
  options.paths = &nul;
  options.path_count = 1;
  EXPECT_TRUE(refused(broken(options).release()));
  afterglow_device_options device = afterglow_device_options_default();
  device.cache_folder = nul;
  afterglow_device* opened = nullptr;
  EXPECT_TRUE(refused(afterglow_device_open(&device, &opened)));

  look("fx.lut {}");
  const StackPtr stack = this->stack();
  ASSERT_TRUE(fine(afterglow_stack_set(stack.get(), str("lut.file"), str(file("table.cube")))));
  EXPECT_TRUE(refused(afterglow_stack_set(stack.get(), str("lut.file"), str(file("table.cube") + '\0' + ".cube"))));
}

TEST_F(ErrorTest, MissingArgumentsAreUsageErrors) {
  const StackPtr stack = this->stack();
  afterglow_stack_options options = afterglow_stack_options_default();
  afterglow_stack* out = nullptr;
  afterglow_text* text = nullptr;
  const afterglow_run_info info = afterglow_run_info_default();
  const ErrorPtr errors[] = {
      ErrorPtr(afterglow_device_open(nullptr, nullptr)),
      ErrorPtr(afterglow_stack_create(nullptr, &options, &out)),
      ErrorPtr(afterglow_stack_create(device_, nullptr, &out)),
      ErrorPtr(afterglow_stack_create(device_, &options, nullptr)),
      ErrorPtr(afterglow_stack_create(device_, &options, &out)),  // no preset
      ErrorPtr(afterglow_stack_run(nullptr, &info)),
      ErrorPtr(afterglow_stack_run(stack.get(), nullptr)),
      ErrorPtr(afterglow_stack_run(stack.get(), &info)),  // no picture
      ErrorPtr(afterglow_stack_settings(nullptr, &text)),
      ErrorPtr(afterglow_stack_settings(stack.get(), nullptr)),
      ErrorPtr(afterglow_stack_set_numbers(stack.get(), str("gain.amount"), nullptr, 1)),
      ErrorPtr(afterglow_stack_get_number(stack.get(), str("gain.amount"), nullptr)),
      ErrorPtr(afterglow_stack_prepare(stack.get(), nullptr, nullptr)),
      ErrorPtr(afterglow_device_describe(nullptr, &text)),
  };
  for (const auto& error : errors) EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_EQ(out, nullptr);
  EXPECT_EQ(text, nullptr);
}

TEST_F(ErrorTest, MessagesSpeakOfTheLibrary) {
  const StackPtr stack = this->stack();
  for (const char* name : {"strength", "gain.", ".amount", "gain=2.amount", ""})
    EXPECT_EQ(text_of(ErrorPtr(afterglow_stack_set_number(stack.get(), str(name), 0.5)).get()),
              "error: '" + std::string(name) + "' is no name of a setting; allowed: ENTRY.SETTING");

  look("fx.gain {}, fx.gain {}, fx.fog {}, fx.fog {}");
  afterglow_stack_options options = listening();
  options.max_memory = 1 << 20;
  const StackPtr small = this->stack(options);
  afterglow_shape shape = afterglow_shape_default();
  shape.width = shape.height = 2048;
  shape.depth = true;
  const ErrorPtr memory(afterglow_stack_prepare(small.get(), &shape, nullptr));
  EXPECT_THAT(text_of(memory.get()), testing::AllOf(HasSubstr("(max_memory)"), Not(HasSubstr("--"))));
  ASSERT_TRUE(fine(afterglow_stack_set_number(small.get(), str("gain.amount"), 2)));
  look("fx.fog {}");
  ASSERT_TRUE(fine(afterglow_stack_reload(small.get(), afterglow_str(nullptr))));
  EXPECT_THAT(messages_, testing::ElementsAre(testing::StartsWith("gain.amount: the stack has no entry 'gain'")));
}

TEST_F(ErrorTest, ReportsSpeakOfTheLibrary) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.reference = true;
  EXPECT_EQ(json_of(afterglow_stack_report, prepared(options).get())["choice_from"], "reference");
  options.reference = false;
  options.precision = AFTERGLOW_PRECISION_FP32;
  EXPECT_THAT(json_of(afterglow_stack_report, prepared(options).get())["choice_from"].get<std::string>(),
              testing::EndsWith("; precision"));
}

TEST_F(ErrorTest, TextsAreUtf8WhateverScriptsSay) {
  afterglow_stack_options options = listening();
  options.preset_text = afterglow_str("print('caf\xE9') error('caf\xE9 \xED\xA0\x80')");
  const ErrorPtr error = broken(options);
  EXPECT_EQ(str(afterglow_error_get_message(error.get())), "caf\uFFFD \uFFFD\uFFFD\uFFFD");
  EXPECT_THAT(text_of(error.get()), testing::AllOf(HasSubstr("caf\uFFFD"), Not(HasSubstr("\xE9"))));
  EXPECT_THAT(messages_, testing::ElementsAre(testing::EndsWith("caf\uFFFD")));

  const std::string name = file("caf\xE9.lua");  // a name is any bytes
  write("caf\xE9.lua", "return 1 +");
  options.preset_text = {};
  options.preset_file = str(name);
  const ErrorPtr named = broken(options);
  EXPECT_THAT(str(afterglow_error_get_file(named.get())), testing::EndsWith("caf\uFFFD.lua"));
}

TEST_F(ErrorTest, CacheFoldersThatCannotBeWrittenToAreTold) {
  const std::string folder = file("look.lua");
  afterglow_device_options options = afterglow_device_options_default();
  options.cache_folder = str(folder);
  options.message = listening().message;
  options.user = &messages_;
  afterglow_device* device = nullptr;
  ASSERT_TRUE(fine(afterglow_device_open(&options, &device)));
  afterglow_device_free(device);
  EXPECT_THAT(messages_,
              testing::Contains(testing::AllOf(HasSubstr(folder), HasSubstr("cannot be written to"))).Times(1));

  messages_.clear();
  const std::string good = file("cache");
  options.cache_folder = str(good);
  ASSERT_TRUE(fine(afterglow_device_open(&options, &device)));
  afterglow_device_free(device);
  EXPECT_THAT(messages_, testing::Not(testing::Contains(HasSubstr("cannot be written to"))));
}

TEST_F(ErrorTest, AnInstallationThatIsNoneIsTold) {
  write("nothing/readme", "");
  const std::string nowhere = file("nothing");
  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = str("neon_night");
  options.installation = str(nowhere);
  const ErrorPtr error = broken(options);
  EXPECT_EQ(str(afterglow_error_get_file(error.get())), nowhere);
  EXPECT_THAT(text_of(error.get()), HasSubstr("is no installation of Afterglow"));
  EXPECT_THAT(text_of(error.get()), HasSubstr("neon_night"));
}

TEST_F(ErrorTest, StructuresOfOtherVersionsAreTaken) {
  // An older host knows no more than the name of the preset.
  struct Older {
    size_t struct_size;
    afterglow_string preset_file;
  } older{sizeof(Older), {}};
  const std::string look = file("look.lua");
  older.preset_file = str(look);
  afterglow_stack* out = nullptr;
  EXPECT_TRUE(fine(afterglow_stack_create(device_, reinterpret_cast<afterglow_stack_options*>(&older), &out)));
  afterglow_stack_free(out);

  // A newer one has more, which counts when it is not zero.
  struct Newer {
    afterglow_stack_options known;
    int more;
  } newer{afterglow_stack_options_default(), 0};
  newer.known.struct_size = sizeof(Newer);
  newer.known.preset_file = str(look);
  out = nullptr;
  EXPECT_TRUE(fine(afterglow_stack_create(device_, &newer.known, &out)));
  afterglow_stack_free(out);
  newer.more = 1;
  const ErrorPtr refused(afterglow_stack_create(device_, &newer.known, &out));
  EXPECT_EQ(afterglow_error_get_kind(refused.get()), AFTERGLOW_ERROR_USAGE);
  EXPECT_THAT(text_of(refused.get()), HasSubstr("this version of the library does not know"));

  newer.known.struct_size = 0;
  const ErrorPtr unset(afterglow_stack_create(device_, &newer.known, &out));
  EXPECT_THAT(text_of(unset.get()), HasSubstr("struct_size is not set"));
}

TEST_F(ErrorTest, DevicesThatAreNotThereAreDeviceErrors) {
  afterglow_device_options options = afterglow_device_options_default();
  options.device = afterglow_str("no such device");
  afterglow_device* device = nullptr;
  const ErrorPtr error(afterglow_device_open(&options, &device));
  EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_DEVICE);
  EXPECT_EQ(device, nullptr);
}

TEST_F(ErrorTest, TheVersionIsThatOfTheHeader) { EXPECT_EQ(afterglow_version(), AFTERGLOW_VERSION); }

}  // namespace
}  // namespace afterglow::test
