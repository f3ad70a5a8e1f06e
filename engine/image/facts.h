// SPDX-License-Identifier: MIT
// What is remembered of a picture's file for the writer.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "image/metadata.h"

namespace afterglow {

struct FileFacts {
  std::filesystem::path file;
  std::string format;        ///< OpenImageIO's name of it: "openexr", "png", …
  int bits = 8;              ///< of a colour sample
  bool floating = false;     ///< half or float samples
  bool had_profile = false;  ///< an ICC profile was embedded
  bool had_chromaticities = false;
  int orientation = 1;
  int part = 0;  ///< of the colour
  std::array<std::string, 4>
      color_channels{};  ///< names in the file of R, G, B, A; grey has the same three; A may be empty
  Metadata metadata;     ///< everything the file said
  std::shared_ptr<const Imf::Header> exr_header;  ///< of the colour's part, when the file was EXR
};

}  // namespace afterglow
