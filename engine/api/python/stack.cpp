// SPDX-License-Identifier: MIT
#include "stack.h"

#include <pybind11/stl.h>

#include <thread>
#include <utility>
#include <variant>

#include "others_run.h"
#include "values.h"

namespace afterglow::python {
namespace {

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

afterglow_precision precision_of(const std::string& name) {
  if (name == "auto") return AFTERGLOW_PRECISION_AUTOMATIC;
  if (name == "fp32") return AFTERGLOW_PRECISION_FP32;
  if (name == "fp16") return AFTERGLOW_PRECISION_FP16;
  refuse("precision is '" + name + "'; allowed: auto, fp32, fp16");
}

afterglow_rect region_of(const py::object& region) {
  if (region.is_none()) return {0, 0, 0, 0};
  const auto [x, y, width, height] =
      cast<std::tuple<int, int, int, int>>(region, "region", "four whole numbers (x, y, width, height)");
  if (width < 1 || height < 1) refuse("region is (x, y, width, height); sides start at 1");
  return {x, y, width, height};
}

}  // namespace

PyStack::PyStack(const py::object& preset, const py::kwargs& given) {
  Options options("Stack", given);
  StackOptions wanted;
  const py::object device = options.take("device");
  wanted.preset_text = options.take("text", std::string());
  if (const py::object paths = options.take("paths"); !paths.is_none()) wanted.paths = path_texts(paths);
  if (const py::object folder = options.take("installation"); !folder.is_none())
    wanted.installation = path_text(folder);
  if (const py::object file = options.take("calibration"); !file.is_none()) wanted.calibration = path_text(file);
  if (const py::object args = options.take("args"); !args.is_none())
    for (const auto& [key, value] : cast<py::dict>(args, "args", "a dict")) {
      const std::string name = py::str(key);
      wanted.arguments.push_back(name + "=" + value_text(name, value));
    }
  wanted.precision = precision_of(options.take("precision", std::string("auto")));
  wanted.max_error = options.take("max_error", 0.0);
  wanted.max_memory = options.take("max_memory", std::uint64_t{0});
  wanted.reference = options.take("reference", false);
  wanted.time_kernels = options.take("time_kernels", false);
  wanted.follow = options.take("follow", false);
  message_ = callback_of(options.take("message"));
  wake_ = callback_of(options.take("wake"));
  wanted.message = sink_of(message_);
  wanted.wake = wake_of(wake_);
  options.finish();
  device_ = device.is_none() ? py::cast(std::make_shared<PyDevice>("auto", false, py::none(), py::none())) : device;
  const auto& shared = cast<const PyDevice&>(device_, "device", "an afterglow.Device");
  device_message_ = shared.message();
  const std::shared_ptr<Device> used = shared.get();
  const std::string file = preset.is_none() ? "" : path_text(preset);
  const OthersRun others;
  stack_ = std::make_unique<Stack>(*used, file, std::move(wanted));
}

PyStack::~PyStack() {
  const bool own = in_own_function();
  // Threads of a stack that follows its files may be waiting to call Python.
  const OthersRun others;
  // On such a thread it cannot wait for that thread's end: the collector may run anywhere.
  if (own) std::thread([gone = std::move(stack_)] {}).detach();
  stack_.reset();
}

void PyStack::close() {
  {
    const auto lock = wait_for_others();
    const OthersRun others;
    stack_.reset();
  }
  clear();
}

int PyStack::visit(visitproc visit, void* arg) const {
  Py_VISIT(device_.ptr());
  if (const int stop = message_->visit(visit, arg)) return stop;
  return wake_->visit(visit, arg);
}

void PyStack::clear() {
  message_->clear();
  wake_->clear();
  const py::object gone = std::exchange(device_, py::object());
}

/// A function of the stack's, or its device's, is what runs on this thread.
bool PyStack::in_own_function() const {
  const auto runs = [](const std::shared_ptr<Callback>& one) { return one && one->is_running(); };
  return runs(message_) || runs(wake_) || runs(device_message_);
}

/// What such a function waits for is waiting for it. Throws std::runtime_error.
std::unique_lock<std::mutex> PyStack::wait_for_others() const {
  if (in_own_function())
    throw std::runtime_error(
        "a stack must not be used in its own message or wake function, nor in the message function of its device");
  const OthersRun others;
  // After fork() the thread that holds the lock is in the other process; the library refuses the call.
  return getpid() == process_ ? std::unique_lock(mutex_) : std::unique_lock(mutex_, std::defer_lock);
}

/// Other Python threads run meanwhile; those that use this stack wait.
template <class Work>
auto PyStack::alone(Work work) const {
  const auto lock = wait_for_others();
  if (!stack_) refuse("the stack is closed");
  const OthersRun others;
  return work();
}

py::object PyStack::json(std::string (Stack::*function)() const) const {
  return from_json(alone([&] { return (stack_.get()->*function)(); }));
}

py::array PyStack::run(const py::object& source, const py::kwargs& given) {
  Options options("run", given);
  std::vector<Picture> kept{input(source, "source", false)};
  afterglow_run_info info = afterglow_run_info_default();
  std::vector<afterglow_image*> images{&info.source};
  const auto auxiliary = [&](const char* name, afterglow_image& image) {
    const py::object array = options.take(name);
    if (array.is_none()) return;
    kept.push_back(input(array, name, true));
    images.push_back(&image);
  };
  auxiliary("depth", info.depth);
  auxiliary("normal", info.normal);
  auxiliary("motion", info.motion);
  const py::object out = options.take("out"), dtype = options.take("dtype");
  if (!out.is_none() && !dtype.is_none()) throw py::type_error("run() takes out or dtype, not both");
  const Picture result = out.is_none() ? output_like(kept[0], dtype) : output(out);
  if (!out.is_none()) keep_apart(kept, result);
  for (std::size_t i = 0; i < kept.size(); ++i) *images[i] = kept[i].image;
  info.result = result.image;
  afterglow_frame frame = afterglow_frame_default();
  frame.number = options.take("frame", frame.number);
  frame.fps = options.take("fps", frame.fps);
  frame.time = options.take("time", frame.number / frame.fps);  // as `afterglow run` counts it
  frame.step = options.take("step", frame.step);
  frame.restart = options.take("restart", false);
  if (const py::object position = options.take("position"); !position.is_none()) {
    const auto [x, y, z] = cast<std::tuple<double, double, double>>(position, "position", "three numbers (x, y, z)");
    frame.has_position = true;
    frame.position[0] = x, frame.position[1] = y, frame.position[2] = z;
  }
  info.frame = &frame;
  info.region = region_of(options.take("region"));
  info.dither = options.take("dither", false);
  options.finish();
  alone([&] { stack_->run(info); });
  return result.array;
}

void PyStack::set(const std::string& name, const py::object& value) {
  const std::string text = value_text(name, value);
  alone([&] { check(afterglow_stack_set(stack_->get(), to_view(name), to_view(text))); });
}

void PyStack::set_several(const py::dict& values) {
  std::vector<std::pair<std::string, std::string>> several;
  for (const auto& [key, value] : values) {
    const std::string name = text_of(py::str(key));
    several.emplace_back(name, value_text(name, value));
  }
  alone([&] { stack_->set(several); });
}

void PyStack::unset(const std::optional<std::string>& name) {
  alone([&] { name ? stack_->unset(*name) : stack_->unset_all(); });
}

void PyStack::set_argument(const std::string& name, const py::object& value) {
  if (value.is_none()) return alone([&] { stack_->unset_argument(name); });
  const std::string text = value_text(name, value);
  alone([&] { stack_->set_argument(name, text); });
}

py::object PyStack::get(const std::string& name) const {
  const std::string prefix = name.substr(0, name.rfind('.')), setting = name.substr(prefix.size() + (name != prefix));
  for (const auto& entry : settings()) {
    if (entry["name"].cast<std::string>() != prefix) continue;
    if (setting == "enabled" || setting == "order" || setting == "at") return entry[setting.c_str()];
    for (const auto& one : entry["settings"])
      if (one["name"].cast<std::string>() == setting) return one["value"];
  }
  return get_plainly(name);
}

/// What is no setting of an effect ("glow.opacity", "glow.mask.luma.from"), of whatever type.
py::object PyStack::get_plainly(const std::string& name) const {
  using Value = std::variant<bool, double, std::vector<double>, std::string>;
  const auto is_so = [](afterglow_error* error) {
    afterglow_error_free(error);
    return !error;
  };
  return py::cast(alone([&]() -> Value {
    bool on = false;
    if (is_so(afterglow_stack_get_boolean(stack_->get(), to_view(name), &on))) return on;
    std::vector<double> numbers(4);
    std::size_t count = 0;
    if (!is_so(afterglow_stack_get_numbers(stack_->get(), to_view(name), numbers.data(), numbers.size(), &count)))
      return stack_->get_text(name);  // or its error, which says what there is
    numbers.resize(count);
    if (count == 1) return numbers[0];
    return numbers;
  }));
}

py::object PyStack::settings() const { return json(&Stack::settings); }
py::object PyStack::arguments() const { return json(&Stack::arguments); }
py::object PyStack::explain() const { return json(&Stack::explain); }
py::object PyStack::report() const { return json(&Stack::report); }

void PyStack::reload(const std::optional<std::string>& text) {
  alone([&] { text ? stack_->reload(*text) : stack_->reload(); });
}

bool PyStack::update() {
  return alone([&] { return stack_->update(); });
}

void PyStack::reset_history() {
  alone([&] { stack_->reset_history(); });
}

}  // namespace afterglow::python
