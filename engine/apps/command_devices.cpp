// SPDX-License-Identifier: MIT
// `afterglow devices`: what --device can choose from.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/options.h"
#include "apps/output.h"
#include "core/json_text.h"
#include "core/table.h"
#include "exec/calibration.h"
#include "gpu/device.h"

namespace afterglow {
namespace {

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

constexpr double kDefaultError = 2e-3;  ///< of a preset that says nothing

std::string as_json(const std::vector<DeviceInfo>& devices, const Calibration& calibration) {
  auto list = nlohmann::json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& device = devices[i];
    nlohmann::json entry{{"index", i},
                         {"name", device.name},
                         {"type", device.type},
                         {"driver", device.driver},
                         {"uuid", device.uuid},
                         {"vulkan", version_text(device.api_version)},
                         {"usable", device.usable},
                         {"few_channels", device.few_channels}};
    if (!device.usable) entry["why_not"] = device.why_not;
    const auto found = calibration.find(device, kDefaultError);
    entry["choice"] = execution_name(found.choice);
    entry["choice_from"] = found.from;
    list.push_back(std::move(entry));
  }
  return json_text(list);
}

std::string as_table(const std::vector<DeviceInfo>& devices, const Calibration& calibration) {
  Table table({"#", "name", "type", "driver", "Vulkan", "usable", "executes", "because of"});
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& device = devices[i];
    const auto found = calibration.find(device, kDefaultError);
    table.add({std::to_string(i), device.name, device.type, device.driver, version_text(device.api_version),
               device.usable ? "yes" : "no: " + device.why_not, execution_name(found.choice), found.from});
  }
  return table.text();
}

}  // namespace

Command add_devices_command(CLI::App& program) {
  auto* app =
      program.add_subcommand("devices", "List the Vulkan devices that --device can choose from, the preferred first");
  auto json = std::make_shared<bool>(false);
  app->add_flag("--json", *json, "Print JSON");
  auto execution = std::make_shared<ExecutionArguments>();  // --calibration alone
  execution->add_calibration(*app);
  return {app, [json, execution](Console&) -> Result<void> {
            const std::string& file = execution->calibration;
            AFTERGLOW_TRY(const auto calibration, file.empty() ? Calibration::shipped() : Calibration::load(file));
            AFTERGLOW_TRY(const auto devices, list_devices());
            output("{}", *json ? as_json(devices, calibration) : as_table(devices, calibration));
            return {};
          }};
}

}  // namespace afterglow
