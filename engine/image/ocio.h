// SPDX-License-Identifier: MIT
// What OpenColorIO reads: look-up tables as steps (lut_file.h), views and colour spaces of configurations as shaders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"
#include "image/lut_file.h"  // IWYU pragma: export

namespace afterglow {

/// Colours of one space of a configuration as a display shows them, or in another space.
///
/// The working space is linear Rec.709. A configuration is asked for it by the names that OpenColorIO's own
/// configurations and their predecessors give it ("Linear Rec.709 (sRGB)", "lin_rec709", …; aliases count). One that
/// knows none of them is asked for its role `aces_interchange` (ACES2065-1), and a matrix brings Rec.709 there.
struct OcioRequest {
  std::filesystem::path config;
  std::string from;           ///< colour space or role; empty: the working space
  std::string display, view;  ///< empty: the configuration's default
  std::string to;         ///< colour space or role, in place of display and view; like `from` a named transform where
                          ///< there are no looks
  bool to_space = false;  ///< `to` counts, and not display and view; an empty `to` is the working space
  std::string looks;      ///< "+name, -name" in place of those of the view; empty: those. Behind each "|" others,
                          ///< for where a file of those before is not there
  bool inverse = false;
};

/// What a request takes.
struct OcioSurvey {
  struct Fault {
    std::string key;  ///< of the request: "view"
    std::string what, allowed, nearest;
  };
  std::optional<Fault> fault;  ///< of the request's names
  struct File {
    std::string name;                              ///< as the configuration writes it
    std::filesystem::path path;                    ///< where it is, or would be looked for first
    std::vector<std::filesystem::path> elsewhere;  ///< the other places, of one that is not there
    bool optional = false;  ///< it is not there, and the look that names it has others in its place ("a | b")
  };
  struct Display {
    std::string name;
    std::vector<std::string> views;
  };
  std::vector<Display> displays;  ///< that the configuration has; empty with a fault
  std::vector<File> files;        ///< tables that OpenColorIO is going to read, whether they are there or not
};

/// Reads the configuration and none of its tables. Thread-safe. Errors (script, with the configuration's file and line
/// where one is known): it cannot be read, spaces that are made of themselves; io: OpenColorIO is not installed.
Result<OcioSurvey> survey_ocio(const OcioRequest& request);

/// A pixel shader by OpenColorIO's own generator. Colours go in and out as the spaces of the request have them; light
/// beyond ±1e12 counts as that. Tables stand in an image that the shader calls `table`.
struct OcioShader {
  std::string text;
  Size size;                 ///< of the table; empty: the shader has none
  std::vector<float> table;  ///< RGBA
};

/// Errors: as above, and tables that cannot be read.
Result<OcioShader> ocio_shader(const OcioRequest& request);

/// Brings RGB triples from one space to another, in place. Thread-safe.
using ColorFunction = std::function<void(float* rgb, std::size_t pixels)>;

/// What a request does, by OpenColorIO on the processor, without approximations.
struct OcioFunction {
  ColorFunction apply;
  std::string display, view;  ///< those that are meant, where the request leaves them to the configuration
};

/// Of OpenColorIO: shaders that it generates are the same for the same version. Empty: it is not installed.
std::string ocio_version();

/// Errors: as above.
Result<OcioFunction> ocio_function(const OcioRequest& request);

}  // namespace afterglow
