// SPDX-License-Identifier: MIT
// What reports say of values that are not finite.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "batch/non_finite_record.h"

namespace afterglow {

/// `input`, `passes` and `untraced`, those that there are; an empty object where all was finite.
nlohmann::ordered_json non_finite_json(const FrameNonFinite& found);
/// Passes that made more than half floats hold.
nlohmann::ordered_json overflows_json(const FrameNonFinite& found);

}  // namespace afterglow
