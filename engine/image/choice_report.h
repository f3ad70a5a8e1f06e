// SPDX-License-Identifier: MIT
// What is told of where the images of a picture are taken from: which channels, which others would have done, and what
// may be meant where there is none.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "image/read_plan.h"

namespace afterglow {

/// "color": "ViewLayer.Combined.RGBA", "depth": "ViewLayer.Depth.Z of depth.exr", …, of those that are `wanted`.
std::map<std::string, std::string> taken_channels(const ReadPlan& plan, const std::vector<std::string>& wanted);

/// For depth, normals and motion that the plan has not: "the file has 'fg.Depth.Z', which may be meant: --depth
/// fg.Depth.Z"; nothing where no channel looks like it.
std::map<std::string, std::string> likely_channels(const ReadPlan& plan);

/// Warns where one of several colours, or of several images that stand as near to them, had to be taken, and notes what
/// was taken.
void report_choices(const ReadPlan& plan, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace afterglow
