// SPDX-License-Identifier: MIT
#include "stack.h"

#include <pybind11/stl.h>

#include <set>
#include <type_traits>
#include <variant>

namespace afterglow::python {
namespace {

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

/// What Python calls a wrong type, it does: pybind11 makes a RuntimeError of it.
template <class T>
T cast(const py::object& value, const std::string& name, const char* what) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + " must be " + what + ", not " +
                         py::type::of(value).attr("__name__").cast<std::string>());
  }
}
template <class T>
constexpr const char* kWhat = std::is_same_v<T, bool>   ? "a bool"
                              : std::is_arithmetic_v<T> ? "a number"
                                                        : "a str";

bool is_bool(const py::handle& value) {
  return py::isinstance<py::bool_>(value) || py::isinstance(value, py::module_::import("numpy").attr("bool_"));
}
bool is_number(const py::handle& value) { return PyNumber_Check(value.ptr()) && !PySequence_Check(value.ptr()); }

/// Options by name, each asked for once; what nobody asked for is unknown.
class Options {
 public:
  Options(const char* function, const py::kwargs& given) : function_(function), given_(given) {}

  py::object take(const char* name) {
    known_.insert(name);
    return given_.contains(name) ? py::object(given_[name]) : py::none();
  }
  template <class T>
  T take(const char* name, T otherwise) {
    const py::object value = take(name);
    return value.is_none() ? otherwise : cast<T>(value, name, kWhat<T>);
  }
  void finish() const {
    for (const auto& [key, value] : given_)
      if (!known_.count(key.cast<std::string>()))
        throw py::type_error(std::string(function_) + "() got an unexpected keyword argument '" +
                             key.cast<std::string>() + "'");
  }

 private:
  const char* function_;
  const py::kwargs& given_;
  std::set<std::string> known_;
};

/// A sink that calls a Python function, or logs to the logger "afterglow" without one.
MessageSink sink_of(const py::object& message) {
  // Python objects may only go while the interpreter's lock is held, and the library forgets sinks where it likes.
  const std::shared_ptr<py::object> call(new py::object(message), [](py::object* object) {
    const py::gil_scoped_acquire lock;
    delete object;
  });
  return [call](afterglow_severity severity, std::string_view text) {
    const py::gil_scoped_acquire lock;
    try {
      const char* level = severity == AFTERGLOW_WARNING ? "warning" : "info";
      if (call->is_none())
        py::module_::import("logging").attr("getLogger")("afterglow").attr(level)("%s", std::string(text));
      else
        (*call)(level, std::string(text));
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("afterglow's message function");
    }
  };
}

std::function<void()> wake_of(const py::object& wake) {
  if (wake.is_none()) return {};
  const std::shared_ptr<py::object> call(new py::object(wake), [](py::object* object) {
    const py::gil_scoped_acquire lock;
    delete object;
  });
  return [call] {
    const py::gil_scoped_acquire lock;
    try {
      (*call)();
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("afterglow's wake function");
    }
  };
}

afterglow_precision precision_of(const std::string& name) {
  if (name == "auto") return AFTERGLOW_PRECISION_AUTOMATIC;
  if (name == "fp32") return AFTERGLOW_PRECISION_FP32;
  if (name == "fp16") return AFTERGLOW_PRECISION_FP16;
  throw py::value_error("precision is '" + name + "'; allowed: auto, fp32, fp16");
}

std::string path_text(const py::handle& path) {
  return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

afterglow_rect region_of(const py::object& region) {
  if (region.is_none()) return {0, 0, 0, 0};
  const auto [x, y, width, height] = cast<std::tuple<int, int, int, int>>(region, "region", "(x, y, width, height)");
  if (width < 1 || height < 1) throw py::value_error("region is (x, y, width, height); sides start at 1");
  return {x, y, width, height};
}

/// As the command line writes it.
std::string argument_text(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_bool(value)) return value.cast<bool>() ? "true" : "false";
  if (is_number(value)) return py::repr(py::float_(py::reinterpret_borrow<py::object>(value))).cast<std::string>();
  std::string text;
  for (const double number : cast<std::vector<double>>(py::reinterpret_borrow<py::object>(value), name,
                                                       "a bool, a number, a str or some numbers"))
    text += (text.empty() ? "{" : ", ") + py::repr(py::float_(number)).cast<std::string>();
  return text + "}";
}

}  // namespace

void raise(const Error& error) {
  const py::module_ module = py::module_::import("afterglow");
  const char* name = error.kind == AFTERGLOW_ERROR_USAGE    ? "UsageError"
                     : error.kind == AFTERGLOW_ERROR_SCRIPT ? "ScriptError"
                     : error.kind == AFTERGLOW_ERROR_IO     ? "FileError"
                     : error.kind == AFTERGLOW_ERROR_DEVICE ? "DeviceError"
                                                            : "Error";
  const py::object type = module.attr(name);
  const auto or_none = [](const std::string& text) { return text.empty() ? py::object(py::none()) : py::str(text); };
  const py::object raised = type(error.what(), error.message, or_none(error.file),
                                 error.line > 0 ? py::object(py::int_(error.line)) : py::none(), or_none(error.allowed),
                                 or_none(error.nearest));
  PyErr_SetObject(type.ptr(), raised.ptr());
}

PyDevice::PyDevice(const std::string& device, bool validate, const std::optional<std::string>& cache,
                   py::object message) {
  DeviceOptions options{device, validate, cache.value_or(""), sink_of(message)};
  const py::gil_scoped_release others;
  device_ = std::make_shared<Device>(std::move(options));
}

py::object PyDevice::describe() const { return from_json(device_->describe()); }

PyStack::PyStack(const py::object& preset, const py::kwargs& given) {
  Options options("Stack", given);
  StackOptions wanted;
  const py::object device = options.take("device");
  wanted.preset_text = options.take("text", std::string());
  if (const py::object paths = options.take("paths"); !paths.is_none())
    for (const auto& path : paths) wanted.paths.push_back(path_text(path));
  if (const py::object folder = options.take("installation"); !folder.is_none())
    wanted.installation = path_text(folder);
  if (const py::object file = options.take("calibration"); !file.is_none()) wanted.calibration = path_text(file);
  if (const py::object args = options.take("args"); !args.is_none())
    for (const auto& [key, value] : cast<py::dict>(args, "args", "a dict")) {
      const std::string name = py::str(key);
      wanted.arguments.push_back(name + "=" + argument_text(name, value));
    }
  wanted.precision = precision_of(options.take("precision", std::string("auto")));
  wanted.max_error = options.take("max_error", 0.0);
  wanted.max_memory = options.take("max_memory", std::uint64_t{0});
  wanted.reference = options.take("reference", false);
  wanted.time_kernels = options.take("time_kernels", false);
  wanted.follow = options.take("follow", false);
  wanted.message = sink_of(options.take("message"));
  wanted.wake = wake_of(options.take("wake"));
  options.finish();
  device_ = device.is_none() ? std::make_shared<PyDevice>("auto", false, std::nullopt, py::none())
                             : cast<std::shared_ptr<PyDevice>>(device, "device", "an afterglow.Device");
  const std::string file = preset.is_none() ? "" : path_text(preset);
  const py::gil_scoped_release others;
  stack_ = std::make_unique<Stack>(device_->get(), file, std::move(wanted));
}

PyStack::~PyStack() {
  // Threads of a stack that follows its files may be waiting to call Python.
  const py::gil_scoped_release others;
  stack_.reset();
}

/// Other Python threads run meanwhile; those that use this stack wait.
template <class Work>
auto PyStack::alone(Work work) const {
  const py::gil_scoped_release others;
  const std::lock_guard lock(mutex_);
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
  frame.time = options.take("time", frame.time);
  frame.fps = options.take("fps", frame.fps);
  frame.step = options.take("step", frame.step);
  frame.restart = options.take("restart", false);
  if (const py::object position = options.take("position"); !position.is_none()) {
    const auto [x, y, z] = cast<std::tuple<double, double, double>>(position, "position", "(x, y, z)");
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
  if (is_bool(value)) {
    const bool on = value.cast<bool>();
    return alone([&] { stack_->set(name, on); });
  }
  if (py::isinstance<py::str>(value)) {
    const auto text = value.cast<std::string>();
    return alone([&] { check(afterglow_stack_set(stack_->get(), to_view(name), to_view(text))); });
  }
  if (is_number(value)) {
    const auto number = cast<double>(value, name, "a number");
    return alone([&] { stack_->set(name, number); });
  }
  const auto numbers = cast<std::vector<double>>(value, name, "a bool, a number, a str or some numbers");
  alone([&] { stack_->set(name, numbers); });
}

void PyStack::unset(const std::optional<std::string>& name) {
  alone([&] { name ? stack_->unset(*name) : stack_->unset_all(); });
}

void PyStack::set_argument(const std::string& name, const py::object& value) {
  if (value.is_none()) return alone([&] { stack_->unset_argument(name); });
  const std::string text = argument_text(name, value);
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
