// Reading and writing pictures, loaded when first needed (see CMakeLists.txt for why it is a module).
#pragma once

#include <filesystem>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/picture.h"
#include "image/reader.h"
#include "image/writer.h"

namespace afterglow {

/// The functions of image/reader.h and image/writer.h, by the same names.
struct PictureFunctions {
  decltype(&afterglow::parse_layer_choice) parse_layer_choice;
  decltype(&afterglow::read_header) read_header;
  decltype(&afterglow::read_picture) read_picture;
  decltype(&afterglow::write_picture) write_picture;
  decltype(&afterglow::check_output) check_output;
};
inline constexpr const char* kPictureFunctionsSymbol = "afterglow_picture_functions";

/// Loads the module; later calls are free. Thread-safe. Errors: other (the installation is broken).
Result<const PictureFunctions*> load_pictures();

}  // namespace afterglow
