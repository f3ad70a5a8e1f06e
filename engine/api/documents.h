// SPDX-License-Identifier: MIT
// What hosts are told as JSON.
#pragma once

#include <optional>
#include <string>

#include "api/backend.h"

namespace afterglow::api {

/// What an entry has under a name that can be set: a setting of its effect goes before what all entries have.
std::optional<SettingValue> entry_value(const StackEntry& entry, const std::string& name);

std::string device_document(const Device& device);
std::string arguments_document(const Backend& backend);
std::string settings_document(Backend& backend);
std::string explain_document(Backend& backend);
std::string report_document(const BackendReport& report, std::uint64_t mended);

}  // namespace afterglow::api
