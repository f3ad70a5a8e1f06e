// SPDX-License-Identifier: MIT
// Which variables of the environment say what a configuration of OpenColorIO means.
#pragma once

#include <set>
#include <string>

namespace afterglow::script {

/// Those that its text names as $NAME, ${NAME} or %NAME%, and those by which OpenColorIO itself chooses displays, views
/// and ways to optimise. OCIO is none of them: it names the file.
std::set<std::string> ocio_variables(const std::string& config);

}  // namespace afterglow::script
