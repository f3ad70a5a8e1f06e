// SPDX-License-Identifier: MIT
// Every format but OpenEXR, through OpenImageIO.
#pragma once

#include <memory>
#include <string>

#include "image/container_check.h"
#include "image/picture_file.h"

namespace afterglow {

Result<std::unique_ptr<PictureFile>> open_with_oiio(const std::filesystem::path& file, const std::string& format,
                                                    const ContainerFacts& container, const SizeLimits& limits);

}  // namespace afterglow
