// SPDX-License-Identifier: MIT
// What hosts are told as JSON.
#pragma once

#include <string>

#include "api/backend.h"

namespace afterglow::api {

std::string device_document(const Device& device);
std::string arguments_document(const Backend& backend);
std::string settings_document(const Backend& backend);
std::string explain_document(const Backend& backend);
std::string report_document(const BackendReport& report, std::uint64_t mended);

}  // namespace afterglow::api
