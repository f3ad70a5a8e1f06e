// SPDX-License-Identifier: MIT
// Lines of an EXR that is stored by ZIP or ZIPS, as most renderers' are: OpenEXR finds the chunks, their bytes are
// unpacked here (exr_zip.h).
#pragma once

#include <OpenEXR/ImfInputPart.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/exr_header.h"
#include "image/picture_file.h"

namespace afterglow {

/// A channel that is wanted: its place among the part's, and where its samples go (ReadTarget).
struct ExrLineTarget {
  std::size_t channel = 0;
  float* base = nullptr;
  std::size_t pixel_stride = 1, row_stride = 0;
};

inline constexpr std::uint16_t kOneAsHalf = 0x3c00;

/// Colours as RGBA of half floats: channels of the part that are half, the fourth maybe none.
struct ExrHalfTarget {
  std::array<std::optional<std::size_t>, 4> channels{};
  std::uint16_t* rgba = nullptr;  ///< without gaps
};

/// Whether `read_zipped_lines` can: lines of ZIP or ZIPS, no channel sub-sampled, wanted ones half or float.
bool has_zipped_lines(const ExrPart& part, std::span<const ExrLineTarget> targets);

/// All lines of the part, on several threads. Besides what ExrPart::buffer_bytes counts it holds up to 32 packed lines
/// of ZIPS. `rows`, if given, is called for the lines of each chunk. Throws what OpenEXR throws, and std::runtime_error
/// when a chunk is damaged.
void read_zipped_lines(Imf::InputPart& input, const ExrPart& part, std::span<const ExrLineTarget> targets,
                       const RowsArrived& rows = {});
/// The same; samples stay as they are. An alpha that is not there becomes 1.
void read_zipped_halves(Imf::InputPart& input, const ExrPart& part, const ExrHalfTarget& target,
                        const RowsArrived& rows = {});

}  // namespace afterglow
