// SPDX-License-Identifier: MIT
// What a stream says of its colours: in its own headers and in those of the file around it.
#pragma once

#include <string>
#include <vector>

#include "image/ffmpeg_handles.h"
#include "image/movie_source.h"

namespace afterglow {

/// Numbers of ITU-T H.273; 2: not said.
struct SaidColor {
  int primaries = 2, transfer = 2, matrix = 2;
};

/// What stands in these, as long as no decoder has written there: as the header of a container was read.
SaidColor said_by(const AVCodecParameters& parameters);

/// What counts. `around`: said by a container of the kind `format` (FFmpeg's name). Where both speak, that of MOV and
/// MP4 goes before (ISO/IEC 14496-12, 12.1.5: the box overrides the bitstream), as does that of any around DNxHD and
/// DNxHR for the matrix, for which decoders take BT.709 where a frame leaves it to the container; elsewhere the
/// stream's own. `differs`: gets a line where they disagree.
MovieColor color_of(const AVFrame& frame, AVCodecID codec, const std::string& format, const SaidColor& around,
                    std::vector<std::string>& differs);

/// The place of chroma, as number.
int chroma_place_of(const AVFrame& frame);

}  // namespace afterglow
