// SPDX-License-Identifier: MIT
#include "stress/picture_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <exception>

#include "image/reader.h"
#include "stress/auxiliary.h"

namespace afterglow::stress {
namespace {

/// The names in the file of an image's channels.
std::vector<const char*> channel_names(const std::string& image) {
  if (image == "depth") return {"Z"};
  if (image == "normal") return {"N.X", "N.Y", "N.Z"};
  if (image == "motion") return {"motion.x", "motion.y"};
  if (image == kMatte) return {"matte.R", "matte.G", "matte.B", "matte.A"};
  return {"R", "G", "B", "A"};
}

void add(Imf::Header& header, Imf::FrameBuffer& buffer, const std::string& name, const Image& image) {
  const auto names = channel_names(name);
  for (std::size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    const std::size_t step = sizeof(float) * static_cast<std::size_t>(image.channels);
    char* base = reinterpret_cast<char*>(const_cast<float*>(image.pixels.data() + c));  // it is read alone
    buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, step, step * static_cast<std::size_t>(image.width)));
  }
}

/// Files have y upwards (image/picture.h).
Image upwards(Image motion) {
  for (std::size_t i = 1; i < motion.pixels.size(); i += 2) motion.pixels[i] = -motion.pixels[i];
  return motion;
}

}  // namespace

Result<void> write_picture_file(const Picture& picture, const std::filesystem::path& file) {
  try {
    Imf::Header header(picture.color.width, picture.color.height);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::FrameBuffer buffer;
    add(header, buffer, "color", picture.color);
    std::map<std::string, Image> auxiliary = picture.auxiliary;
    for (auto& [name, image] : auxiliary) {
      if (name == "motion") image = upwards(std::move(image));
      add(header, buffer, name, image);
    }
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(picture.color.height);
    return {};
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, error.what(), file.string()};
  }
}

Result<Picture> read_picture_file(const std::filesystem::path& file, Diagnostics& diagnostics) {
  ReadOptions options;
  options.auxiliary = {"depth", "normal", "motion", kMatte};
  return read_picture(file, options, diagnostics);
}

}  // namespace afterglow::stress
