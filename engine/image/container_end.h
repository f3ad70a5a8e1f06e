// SPDX-License-Identifier: MIT
// Whether a video file, or a stream, ends where something of it ends: by how long its parts say that they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace afterglow {

/// What was read, to be looked at again. Of a stream only the beginning and the end are kept.
struct PlacedBytes {
  std::uint64_t size = 0;
  /// So many bytes from a place on; fewer: the others are not there, or not kept. Valid until the next call.
  std::function<std::string_view(std::uint64_t at, std::size_t count)> look;
};

/// It ends within something. False where that is not known: parts that do not say how long they are, or no parts at
/// all. `format`: as MovieRequest; `last`: where the data of the last packet end, 0 if that is not known.
bool ends_early(std::string_view format, const PlacedBytes& bytes, std::uint64_t last);

}  // namespace afterglow
