// SPDX-License-Identifier: MIT
// Afterglow for C++17 and later: afterglow.h in classes that own what they hold and throw afterglow::Error.
//
//   afterglow::Device device;
//   afterglow::Stack stack(device, "look.lua");
//   stack.set("glow.intensity", 0.4);
//   stack.run(afterglow::image(pixels.data(), width, height), afterglow::image(pixels.data(), width, height));
//
// Threads: as afterglow.h says of the functions of the same names. Everything is inline: this header only needs the
// shared library.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "afterglow.h"

namespace afterglow {

inline std::string to_string(afterglow_string view) { return view.data ? std::string(view.data, view.size) : ""; }
inline afterglow_string to_view(std::string_view text) { return {text.data() ? text.data() : "", text.size()}; }

/// What went wrong; `what` is the text that users see, with file and line.
class Error : public std::runtime_error {
 public:
  /// Takes the object over.
  explicit Error(afterglow_error* error) : Error(std::unique_ptr<afterglow_error, Free>(error)) {}

  afterglow_error_kind kind;
  std::string message, file, allowed, nearest;
  int line;  ///< from 1; 0: none is known

 private:
  struct Free {
    void operator()(afterglow_error* error) const { afterglow_error_free(error); }
  };
  explicit Error(const std::unique_ptr<afterglow_error, Free>& error)
      : std::runtime_error(to_string(afterglow_error_get_text(error.get()))),
        kind(afterglow_error_get_kind(error.get())),
        message(to_string(afterglow_error_get_message(error.get()))),
        file(to_string(afterglow_error_get_file(error.get()))),
        allowed(to_string(afterglow_error_get_allowed(error.get()))),
        nearest(to_string(afterglow_error_get_nearest(error.get()))),
        line(afterglow_error_get_line(error.get())) {}
};

/// Throws when there is an error.
inline void check(afterglow_error* error) {
  if (error) throw Error(error);
}

namespace detail {

/// Calls a function that hands a text over.
template <class Function>
std::string text_from(Function function) {
  afterglow_text* text = nullptr;
  check(function(&text));
  const std::unique_ptr<afterglow_text, void (*)(afterglow_text*)> owner(text, afterglow_text_free);
  return to_string(afterglow_text_get(text));
}

/// Integers of all sizes, and enumerators that are used as such; a boolean is none.
template <class T>
constexpr bool is_whole = (std::is_integral_v<T> && !std::is_same_v<T, bool>) ||
                          (std::is_enum_v<T> && std::is_convertible_v<T, int>);

}  // namespace detail

/// May be called on any thread. What it throws is lost.
using MessageSink = std::function<void(afterglow_severity, std::string_view)>;

struct DeviceOptions {
  std::string device = "auto";  ///< "auto", an index, or a part of a name or uuid
  bool validate = false;
  std::string cache_folder{};  ///< empty: nothing is kept on disk
  MessageSink message{};
};

class Device {
 public:
  explicit Device(DeviceOptions options = {}) : sink_(std::make_unique<MessageSink>(std::move(options.message))) {
    afterglow_device_options given = afterglow_device_options_default();
    given.device = to_view(options.device);
    given.validate = options.validate;
    if (!options.cache_folder.empty()) given.cache_folder = to_view(options.cache_folder);
    given.message = callback();
    given.user = sink_.get();
    afterglow_device* made = nullptr;
    check(afterglow_device_open(&given, &made));
    handle_.reset(made);
  }
#if defined(VULKAN_CORE_H_)
  /// `adopted.message` and `adopted.user` are set by this class.
  explicit Device(afterglow_adopted_device adopted, MessageSink message = {})
      : sink_(std::make_unique<MessageSink>(std::move(message))) {
    adopted.message = callback();
    adopted.user = sink_.get();
    afterglow_device* made = nullptr;
    check(afterglow_device_adopt(&adopted, &made));
    handle_.reset(made);
  }
#endif

  Device(Device&&) noexcept = default;
  /// The device before goes ahead of its sink, which it may still call.
  Device& operator=(Device&& other) noexcept {
    handle_ = std::move(other.handle_);
    sink_ = std::move(other.sink_);
    return *this;
  }

  afterglow_device* get() const { return handle_.get(); }
  std::string describe() const {  ///< JSON
    return detail::text_from([this](afterglow_text** out) { return afterglow_device_describe(get(), out); });
  }

 private:
  static void forward(void* user, afterglow_severity severity, afterglow_string message) {
    try {
      (*static_cast<MessageSink*>(user))(severity, std::string_view(message.data, message.size));
    } catch (...) {
    }
  }
  afterglow_message_callback callback() const { return *sink_ ? &forward : nullptr; }

  struct Free {
    void operator()(afterglow_device* device) const { afterglow_device_free(device); }
  };
  // Stacks keep the device alive, and it its sink: whoever moves or ends a Device leaves the sink to them.
  std::shared_ptr<MessageSink> sink_;
  std::unique_ptr<afterglow_device, Free> handle_;
  friend class Stack;
};

struct StackOptions {
  std::string preset_text{};  ///< empty: the file's
  std::vector<std::string> paths{};
  std::string installation{}, calibration{};
  afterglow_use use = AFTERGLOW_USE_HOST_MEMORY;
  afterglow_precision precision = AFTERGLOW_PRECISION_AUTOMATIC;
  double max_error = 0;
  std::uint64_t max_memory = 0;
  bool reference = false, time_kernels = false, follow = false;
  MessageSink message{};
  std::function<void()> wake{};          ///< called on threads of the library; must not throw
  std::vector<std::string> arguments{};  ///< "NAME=VALUE", of what the preset declares by fx.args
};

/// Pixels of the caller, packed: floats, halves (as std::uint16_t) or 8-bit codes.
template <class Sample>
afterglow_image image(Sample* pixels, int width, int height, int channels = 4) {
  using Plain = std::remove_const_t<Sample>;
  static_assert(
      std::is_same_v<Plain, float> || std::is_same_v<Plain, std::uint16_t> || std::is_same_v<Plain, std::uint8_t>,
      "samples are float, std::uint16_t (halves) or std::uint8_t");
  afterglow_image out{};
  out.data = const_cast<Plain*>(pixels);
  out.width = width;
  out.height = height;
  out.channels = channels;
  out.samples = std::is_same_v<Plain, float>           ? AFTERGLOW_FLOAT
                : std::is_same_v<Plain, std::uint16_t> ? AFTERGLOW_HALF
                                                       : AFTERGLOW_UINT8;
  return out;
}

class Stack {
 public:
  /// `preset`: a file, a pack, or the name of a preset; with `options.preset_text` the name that messages give it.
  Stack(const Device& device, std::string_view preset, StackOptions options = {})
      : device_sink_(device.sink_),
        calls_(std::make_unique<Calls>(Calls{std::move(options.message), std::move(options.wake)})) {
    afterglow_stack_options given = afterglow_stack_options_default();
    std::vector<afterglow_string> paths;
    for (const std::string& path : options.paths) paths.push_back(to_view(path));
    std::vector<afterglow_string> arguments;
    for (const std::string& argument : options.arguments) arguments.push_back(to_view(argument));
    if (!preset.empty()) given.preset_file = to_view(preset);
    if (!options.preset_text.empty()) given.preset_text = to_view(options.preset_text);
    given.paths = paths.data();
    given.path_count = paths.size();
    given.arguments = arguments.data();
    given.argument_count = arguments.size();
    if (!options.installation.empty()) given.installation = to_view(options.installation);
    if (!options.calibration.empty()) given.calibration = to_view(options.calibration);
    given.use = options.use;
    given.precision = options.precision;
    given.max_error = options.max_error;
    given.max_memory = options.max_memory;
    given.reference = options.reference;
    given.time_kernels = options.time_kernels;
    given.follow = options.follow;
    if (calls_->message) given.message = &Calls::tell;
    if (calls_->wake) given.wake = &Calls::awaken;
    given.user = calls_.get();
    afterglow_stack* made = nullptr;
    check(afterglow_stack_create(device.get(), &given, &made));
    handle_.reset(made);
  }

  Stack(Stack&&) noexcept = default;
  /// The stack before ends ahead of its callbacks, which its threads may still call.
  Stack& operator=(Stack&& other) noexcept {
    handle_ = std::move(other.handle_);
    calls_ = std::move(other.calls_);
    device_sink_ = std::move(other.device_sink_);
    return *this;
  }

  afterglow_stack* get() const { return handle_.get(); }

  void run(const afterglow_run_info& info) { check(afterglow_stack_run(get(), &info)); }
  void run(const afterglow_image& source, const afterglow_image& result) {
    afterglow_run_info info = afterglow_run_info_default();
    info.source = source;
    info.result = result;
    run(info);
  }

  void set(std::string_view name, double value) { check(afterglow_stack_set_number(get(), to_view(name), value)); }
  template <class Whole, std::enable_if_t<detail::is_whole<Whole>, int> = 0>
  void set(std::string_view name, Whole value) {
    set(name, static_cast<double>(value));
  }
  void set(std::string_view name, bool value) { check(afterglow_stack_set_boolean(get(), to_view(name), value)); }
  void set(std::string_view name, const char* value) { set(name, std::string_view(value)); }
  void set(std::string_view name, std::string_view value) {
    check(afterglow_stack_set_text(get(), to_view(name), to_view(value)));
  }
  void set(std::string_view name, const std::vector<double>& values) {
    check(afterglow_stack_set_numbers(get(), to_view(name), values.data(), values.size()));
  }
  /// Names and values as text, all or none.
  void set(const std::vector<std::pair<std::string, std::string>>& several) {
    std::vector<afterglow_string> names, values;
    for (const auto& [name, value] : several) {
      names.push_back(to_view(name));
      values.push_back(to_view(value));
    }
    check(afterglow_stack_set_several(get(), names.data(), values.data(), several.size()));
  }
  void unset(std::string_view name) { check(afterglow_stack_unset(get(), to_view(name))); }
  void unset_all() { check(afterglow_stack_unset(get(), afterglow_str(nullptr))); }

  void set_argument(std::string_view name, std::string_view value) {
    check(afterglow_stack_set_argument(get(), to_view(name), to_view(value)));
  }
  void unset_argument(std::string_view name) {
    check(afterglow_stack_set_argument(get(), to_view(name), afterglow_str(nullptr)));
  }

  double get_number(std::string_view name) const {
    double out = 0;
    check(afterglow_stack_get_number(get(), to_view(name), &out));
    return out;
  }
  bool get_boolean(std::string_view name) const {
    bool out = false;
    check(afterglow_stack_get_boolean(get(), to_view(name), &out));
    return out;
  }
  std::string get_text(std::string_view name) const {
    return detail::text_from([&](afterglow_text** out) { return afterglow_stack_get_text(get(), to_view(name), out); });
  }
  std::vector<double> get_numbers(std::string_view name) const {
    std::vector<double> out(4);
    std::size_t count = 0;
    check(afterglow_stack_get_numbers(get(), to_view(name), out.data(), out.size(), &count));
    out.resize(count);
    return out;
  }

  std::string settings() const {  ///< JSON, as the three below
    return detail::text_from([this](afterglow_text** out) { return afterglow_stack_settings(get(), out); });
  }
  std::string arguments() const {
    return detail::text_from([this](afterglow_text** out) { return afterglow_stack_arguments(get(), out); });
  }
  std::string explain() const {
    return detail::text_from([this](afterglow_text** out) { return afterglow_stack_explain(get(), out); });
  }
  std::string report() const {
    return detail::text_from([this](afterglow_text** out) { return afterglow_stack_report(get(), out); });
  }

  void prepare(const afterglow_shape& shape, const afterglow_frame& frame = afterglow_frame_default()) {
    check(afterglow_stack_prepare(get(), &shape, &frame));
  }
  bool runs() const { return afterglow_stack_runs(get()); }
  void reset_history() { afterglow_stack_reset_history(get()); }

  bool update() {
    bool changed = false;
    check(afterglow_stack_update(get(), &changed));
    return changed;
  }
  void reload() { check(afterglow_stack_reload(get(), afterglow_str(nullptr))); }
  void reload(std::string_view preset_text) { check(afterglow_stack_reload(get(), to_view(preset_text))); }

#if defined(VULKAN_CORE_H_)
  VkFormat result_format() const { return afterglow_stack_result_format(get()); }
  void bind(const afterglow_bindings& bindings) { check(afterglow_stack_bind(get(), &bindings)); }
  void record(VkCommandBuffer commands) { check(afterglow_stack_record(get(), commands)); }
#endif

 private:
  struct Calls {
    MessageSink message;
    std::function<void()> wake;
    static void tell(void* user, afterglow_severity severity, afterglow_string message) {
      try {
        static_cast<Calls*>(user)->message(severity, std::string_view(message.data, message.size));
      } catch (...) {
      }
    }
    static void awaken(void* user) { static_cast<Calls*>(user)->wake(); }
  };
  struct Free {
    void operator()(afterglow_stack* stack) const { afterglow_stack_free(stack); }
  };
  std::shared_ptr<MessageSink> device_sink_;
  std::unique_ptr<Calls> calls_;
  std::unique_ptr<afterglow_stack, Free> handle_;
};

}  // namespace afterglow
