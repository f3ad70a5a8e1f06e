// SPDX-License-Identifier: MIT
#include "image/write_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>

#include "image/exr_line_writer.h"
#include "image/exr_primaries.h"
#include "image/exr_rows.h"
#include "image/metadata.h"
#include "image/output_metadata.h"

namespace afterglow {
Result<void> write_exr(const Picture& picture, OutputFile& out, const std::string& name, const WriteOptions& options,
                       Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const OutputFormat* format, output_format("x.exr", options));
  Imf::Header header(exr_window(picture.display_window), exr_window(picture.data_window));
  header.channels() = Imf::ChannelList();
  if (picture.facts) add_kept_attributes(header, *picture.facts);
  if (options.space) Imf::addChromaticities(header, exr_chromaticities(options.space->primaries()));
  AFTERGLOW_CHECK(set_compression(header, options.compression));
  ExrColorRows rows(picture, {"R", "G", "B", picture.has_alpha ? "A" : ""},
                    sample_type(*format, options, picture.facts.get()));
  rows.add_channels(header);
  if (can_pack_lines(header)) {
    rows.find_places(header);
    ExrLineWriter file(header, out);
    file.write(picture.color.height, [&](int y, std::uint8_t* line) { rows.put_row(y, line); });
    file.finish();
  } else {
    ExrOutput stream(out, name.c_str());
    Imf::OutputFile file(stream, header);
    for (int y = 0; y < picture.color.height; y += ExrColorRows::kRows) {
      const int count = std::min(ExrColorRows::kRows, picture.color.height - y);
      Imf::FrameBuffer buffer;
      rows.add_slices(y, count, buffer);
      file.setFrameBuffer(buffer);
      file.writePixels(count);
    }
  }  // the destructor writes the offset table; a failure of that is found in `out`
  rows.warn_of_overflow(header, diagnostics);
  return {};
}

}  // namespace afterglow
