// SPDX-License-Identifier: MIT
// What a file's own head says of its colours: profiles, numbers of H.273, chunks of PNG. Internal to the room.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/diagnostics.h"
#include "image/color_encoding.h"
#include "image/container_check.h"

namespace afterglow {

/// Over what `encoding` has, of which `grey` and `max_code` are known. `profile`: ICC, or empty. What cannot be used is
/// warned of with `name` in front. True: that is all there is to say; what a library guesses does not count.
bool use_container_color(const ContainerFacts& container, std::span<const std::uint8_t> profile,
                         const std::string& name, ColorEncoding& encoding, Diagnostics& diagnostics);

}  // namespace afterglow
