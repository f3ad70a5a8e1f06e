// SPDX-License-Identifier: MIT
// The file in which a device keeps its compiled pipelines: our hash of the data, then the data. Drivers check little
// more than the header, and a file cut short by a full disk must not reach them.
#pragma once

#include <string>

#include "gpu/vulkan.h"

namespace afterglow {

/// What a file with this pipeline cache data holds.
std::string pipeline_cache_file_content(const std::string& data);

/// The data of a file, or empty when it is missing, damaged or of another device or driver.
std::string read_pipeline_cache(const std::string& file, const VkPhysicalDeviceProperties& device);

}  // namespace afterglow
