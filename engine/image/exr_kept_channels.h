// SPDX-License-Identifier: MIT
// Channels of an EXR's part that stand beside the colour and are written again as they are.
#pragma once

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// Read and written in their own types, strip by strip, in a window that holds the part's own: what lies between the
/// two is 0, of depths infinitely far.
class ExrKeptChannels {
 public:
  /// Those of a part with this header whose names are not `replaced`, for a file with the data window `window`.
  ExrKeptChannels(const Imf::Header& header, const std::vector<std::string>& replaced, const Imath::Box2i& window);

  /// Errors: io (channels at less than full resolution are not copied; the window does not hold the part's own).
  Result<void> check() const;
  bool empty() const { return channels_.empty(); }
  /// Names of the layers, those of channels without one, which this compression would change. `compression`: by its
  /// name, without a level.
  std::vector<std::string> changed_by(std::string_view compression) const;

  void add_channels(Imf::Header& header) const;
  /// Holds `rows` rows from row `y` on, in the file's coordinates.
  void read(Imf::InputPart& part, int y, int rows);
  /// Slices of these rows.
  void add_slices(Imf::FrameBuffer& buffer);
  /// Row `row` of these, into a line of a file with this header: see ExrLineWriter.
  void put_row(const Imf::Header& header, int row, std::uint8_t* line) const;

 private:
  struct Kept {
    std::string name;
    Imf::Channel channel;
    std::array<std::uint8_t, 4> nothing{};  ///< a sample where the part has none
    std::vector<std::uint8_t> samples;

    std::size_t sample_bytes() const { return channel.type == Imf::HALF ? 2 : 4; }
  };
  std::size_t width() const { return static_cast<std::size_t>(window_.max.x - window_.min.x) + 1; }

  Imath::Box2i own_, window_;
  std::vector<Kept> channels_;
  int first_ = 0, rows_ = 0;  ///< that are held
};

}  // namespace afterglow
