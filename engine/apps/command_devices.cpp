// `afterglow devices`: what --device can choose from.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/table.h"
#include "gpu/device.h"

namespace afterglow {
namespace {

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

std::string as_json(const std::vector<DeviceInfo>& devices) {
  auto list = nlohmann::json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& device = devices[i];
    nlohmann::json entry{{"index", i},
                         {"name", device.name},
                         {"type", device.type},
                         {"driver", device.driver},
                         {"uuid", device.uuid},
                         {"vulkan", version_text(device.api_version)},
                         {"usable", device.usable}};
    if (!device.usable) entry["why_not"] = device.why_not;
    list.push_back(std::move(entry));
  }
  return list.dump(2) + "\n";
}

std::string as_table(const std::vector<DeviceInfo>& devices) {
  Table table({"#", "name", "type", "driver", "Vulkan", "usable"});
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& device = devices[i];
    table.add({std::to_string(i), device.name, device.type, device.driver, version_text(device.api_version),
               device.usable ? "yes" : "no: " + device.why_not});
  }
  return table.text();
}

}  // namespace

Command add_devices_command(CLI::App& program) {
  auto* app =
      program.add_subcommand("devices", "List the Vulkan devices that --device can choose from, the preferred first");
  auto json = std::make_shared<bool>(false);
  app->add_flag("--json", *json, "Print JSON");
  return {app, [json](Console&) -> Result<void> {
            AFTERGLOW_TRY(const auto devices, list_devices());
            fmt::print("{}", *json ? as_json(devices) : as_table(devices));
            return {};
          }};
}

}  // namespace afterglow
