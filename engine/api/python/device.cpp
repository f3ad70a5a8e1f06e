// SPDX-License-Identifier: MIT
#include <utility>

#include "others_run.h"
#include "stack.h"
#include "values.h"

namespace afterglow::python {

PyDevice::PyDevice(const std::string& device, bool validate, const py::object& cache, const py::object& message)
    : message_(callback_of(message)) {
  DeviceOptions options{device, validate, cache.is_none() ? "" : path_text(cache), sink_of(message_)};
  const OthersRun others;
  device_ = std::make_shared<Device>(std::move(options));
}

std::shared_ptr<Device> PyDevice::get() const {
  if (!device_) refuse("the device is closed");
  return device_;
}

py::object PyDevice::describe() const { return py::module_::import("json").attr("loads")(get()->describe()); }

void PyDevice::close() {
  std::shared_ptr<Device> gone = std::exchange(device_, nullptr);
  const OthersRun others;
  gone.reset();
}

}  // namespace afterglow::python
