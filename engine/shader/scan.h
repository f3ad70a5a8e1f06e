// SPDX-License-Identifier: MIT
// Finds what one file of GLSL declares at file scope, by its tokens. Internal to the room.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "shader/declared.h"
#include "shader/directives.h"
#include "shader/interface.h"
#include "shader/token.h"

namespace afterglow {

/// Something that the file names at file scope.
struct GlobalName {
  std::string name;
  bool macro = false;
  int line = 0;
  bool with_arguments = false;             ///< a macro that has them
  std::vector<bool> field_arguments = {};  ///< of such a macro: which of them are names of fields
};

/// A variable that the invocations of a workgroup share.
struct SharedVariable {
  std::string name, type;
  bool array = false;
  int line = 0;
};

struct ShaderScan {
  std::vector<Token> tokens;  ///< views of the scanned text
  ShaderInterface interface;  ///< `kind` means nothing for a library
  std::vector<GlobalName> names;
  std::vector<IncludeLine> includes;
  std::vector<Unset> unset;  ///< variables without a value of their own
  std::vector<SharedVariable> shared;
  bool keeps_state = false;  ///< it has variables at file scope that functions may write
  std::vector<Edit> edits;   ///< in order of the text
};

enum class ScanAs {
  stage,   ///< an author's shader: exactly one entry point (PassKindInfo::entry)
  library  ///< an included file: none of them, no uniforms, no specialised constants
};

/// A text with what it declares, so that no file is scanned twice: it never moves, and its tokens stay good.
struct ShaderFile {
  std::string text;
  ShaderScan scan;
};

/// `text` must outlive the result. Errors (script) name `file` and the line.
Result<ShaderScan> scan(std::string_view text, const std::string& file, ScanAs as);
Result<std::shared_ptr<const ShaderFile>> scan_file(std::string text, const std::string& file, ScanAs as);

}  // namespace afterglow
