// SPDX-License-Identifier: MIT
// Devices of the C interface.
#include <fmt/format.h>

#include <utility>

#include "api/documents.h"
#include "api/handles.h"

using namespace afterglow;
using namespace afterglow::api;

namespace {

/// `open` makes the device of a SharedDevice.
template <class Open>
Result<void> make(afterglow_message_callback message, void* user, afterglow_device** out, Open open) {
  auto shared = std::make_shared<SharedDevice>(sink_of(message, user));
  AFTERGLOW_CHECK(open(*shared));
  *out = new afterglow_device{std::move(shared)};
  return {};
}

}  // namespace

afterglow_error* afterglow_device_open(const afterglow_device_options* options, afterglow_device** out) {
  return call([&]() -> Result<void> {
    if (!out) return usage("afterglow_device_open: out is NULL");
    *out = nullptr;
    afterglow_device_options given = afterglow_device_options_default();
    if (options) {
      AFTERGLOW_TRY(given, take(options, given, "afterglow_device_options"));
    }
    AFTERGLOW_TRY(const auto cache_folder, path_of(given.cache_folder));
    DeviceOptions wanted;
    if (is_given(given.device)) wanted.device = text_of(given.device);
    wanted.validate = given.validate;
    return make(given.message, given.user, out,
                [&](SharedDevice& device) { return device.open(wanted, cache_folder); });
  });
}

afterglow_error* afterglow_device_adopt(const afterglow_adopted_device* adopted, afterglow_device** out) {
  return call([&]() -> Result<void> {
    if (!out) return usage("afterglow_device_adopt: out is NULL");
    *out = nullptr;
    AFTERGLOW_TRY(const auto given, take(adopted, afterglow_adopted_device_default(), "afterglow_adopted_device"));
    const std::pair<const char*, bool> missing[] = {{"instance", !given.instance},
                                                    {"physical_device", !given.physical_device},
                                                    {"device", !given.device},
                                                    {"queue", !given.queue}};
    for (const auto& [name, is_missing] : missing)
      if (is_missing) return usage(fmt::format("afterglow_adopted_device: {} is NULL", name));
    AFTERGLOW_TRY(const auto cache_folder, path_of(given.cache_folder));
    const AdoptedDevice objects{.instance = given.instance,
                                .physical_device = given.physical_device,
                                .device = given.device,
                                .queue = given.queue,
                                .queue_family = given.queue_family,
                                .get_instance_proc_addr = given.get_instance_proc_addr};
    return make(given.message, given.user, out,
                [&](SharedDevice& device) { return device.adopt(objects, cache_folder); });
  });
}

void afterglow_device_free(afterglow_device* device) {
  if (device && device->shared->is_of_this_process()) delete device;
}

afterglow_error* afterglow_device_describe(const afterglow_device* device, afterglow_text** out) {
  return call([&]() -> Result<void> {
    if (!device) return usage("afterglow_device_describe: device is NULL");
    AFTERGLOW_CHECK(device->shared->check_process());
    return give(device_document(*device->shared->device), out, "afterglow_device_describe");
  });
}
