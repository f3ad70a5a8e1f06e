// SPDX-License-Identifier: MIT
// Parts of OpenColorIO's configurations, for g:ocio.
#pragma once

#include <string>

#include "image/ocio.h"
#include "script/assets.h"

namespace afterglow::script {

/// The shader for a request; its `config` is left to `config`, the name of a file as find_asset takes it, or empty for
/// the one that the variable OCIO of the environment names. Tables of a configuration that a script names must lie in
/// the folders that scripts may read; those of one that the environment or the command line names may lie anywhere. All
/// files become part of the look before they are read. Errors: throws ScriptError; what is wrong with a name of the
/// request, at the setting where it comes from.
const LoadedOcio& load_ocio(lua_State* lua, const std::string& what, const std::string& config, OcioRequest request);

}  // namespace afterglow::script
