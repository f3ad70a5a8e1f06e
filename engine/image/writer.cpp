// SPDX-License-Identifier: MIT
#include "image/writer.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "core/exception.h"
#include "core/file.h"
#include "core/file_stamp.h"
#include "core/file_time.h"
#include "core/temporary.h"
#include "core/text.h"
#include "image/dpx_header.h"
#include "image/encode.h"
#include "image/exr_file.h"
#include "image/exr_primaries.h"
#include "image/lost_file.h"
#include "image/oiio_module.h"
#include "image/output_file.h"
#include "image/output_format.h"
#include "image/reader.h"
#include "image/strips.h"
#include "image/time_code.h"
#include "image/video_output.h"
#include "image/write_cineon.h"
#include "image/write_exr.h"
#include "image/write_png.h"
#include "image/write_pnm.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// Is there light where alpha is 0, as glows around a layer are? Programs that read straight alpha show nothing there.
/// What hardly shows does not count, nor do a few pixels.
bool glows_outside(const Picture& picture) {
  constexpr float kLight = 0.01f;
  constexpr std::uint8_t kCode = 26;  // of that
  if (!picture.has_alpha) return false;
  const auto width = static_cast<std::size_t>(picture.color.width),
             height = static_cast<std::size_t>(picture.color.height);
  const auto glow = [](const auto* pixel, auto least) {
    return pixel[3] == 0 && std::max({pixel[0], pixel[1], pixel[2]}) >= least;
  };
  const std::size_t few = std::max<std::size_t>(width * height / 10000, 15);
  std::size_t pixels = 0;
  std::vector<float> memory;
  for (std::size_t y = 0; y < height && pixels <= few; ++y) {
    if (!picture.unorm8.empty()) {
      for (std::size_t x = 0; x < width; ++x) pixels += glow(&picture.unorm8[4 * (width * y + x)], kCode);
      continue;
    }
    const float* row = color_row(picture, static_cast<int>(y), memory);
    for (std::size_t x = 0; x < width; ++x) pixels += glow(&row[4 * x], kLight);
  }
  return pixels > few;
}

Result<void> write_format(const Picture& picture, const OutputFormat& format, OutputFile& out, const std::string& name,
                          const WriteOptions& options, Diagnostics& diagnostics) {
  const StripForm form = strip_form(picture, format, options);
  if (!form.alpha && has_transparency(picture))
    diagnostics.warn(fmt::format("{} files have no alpha{}; the picture is put on black",
                                 format.extensions[0].substr(1),
                                 format.alpha ? " in 10 bits (--type uint16 has)" : ""));
  const bool codes = form.type != SampleType::half && form.type != SampleType::float32;  // their alpha is straight
  if (format.kind != OutputKind::exr && form.alpha && codes && glows_outside(picture))
    diagnostics.warn_once("glow outside",
                          fmt::format("light that glows where alpha is 0 is not seen in {} files; EXR keeps it",
                                      format.extensions[0].substr(1)));
  switch (format.kind) {
    case OutputKind::exr:
      break;
    case OutputKind::png:
      return write_png(picture, form, out, options.png_level.value_or(1), options.memory);
    case OutputKind::cineon:
      return write_cineon(picture, form, out);
    case OutputKind::ppm:
    case OutputKind::pam:
    case OutputKind::pfm:
      return write_pnm(picture, format.kind, form, out);
    default:
      AFTERGLOW_TRY(const OiioModule* module, oiio_module());
      return module->write(picture, format, out, name, options);
  }
  use_exr_threads();
  const auto write = options.keep_layers ? write_exr_with_layers : write_exr;
  if (const auto primaries = written_primaries(picture, options))
    return write(in_primaries(picture, *primaries), out, name, options, diagnostics);
  return write(picture, out, name, options, diagnostics);
}

/// Writes `temporary` through an OutputFile; it will be called `name`. What the file itself reports ("No space left on
/// device") goes before what a library makes of it.
Result<void> write_through(const Picture& picture, const OutputFormat& format, const fs::path& temporary,
                           const std::string& name, const WriteOptions& options, Diagnostics& diagnostics) {
  OutputFile out(temporary);
  Result<void> written;
  try {
    if (!out.failure()) written = write_format(picture, format, out, temporary.string(), options, diagnostics);
    if (written && format.kind == OutputKind::dpx) {
      pad_dpx_lines(out);
      set_dpx_name_and_time(picture, name, out);
    }
  } catch (const std::exception& error) {
    written = Error{ErrorKind::io, "cannot be written: " + exception_text(error)};
  }
  AFTERGLOW_CHECK(out.close());
  AFTERGLOW_CHECK(written);
  std::error_code ec;
  if (fs::file_size(temporary, ec) != out.size() || ec) return lost_file(temporary);
  return {};
}

/// Writes to `temporary` and makes sure that it is all there.
Result<void> write_checked(const Picture& picture, const OutputFormat& format, const fs::path& temporary,
                           const std::string& name, const WriteOptions& options, Diagnostics& diagnostics) {
  AFTERGLOW_CHECK(write_through(picture, format, temporary, name, options, diagnostics));
  // An OutputFile has seen every byte go out; what it cannot see is a library that stopped early without saying so.
  if (format.kind == OutputKind::png || format.kind == OutputKind::pam || options.keep_layers) return {};
  ReadOptions anything;
  anything.max_side = 1 << 30;
  anything.max_bytes = ~0ull;
  const auto header = read_header(temporary, anything);
  if (!header) return Error{ErrorKind::io, "cannot be written: reading it back failed: " + header.error().message};
  return {};
}

Result<void> check_picture(const Picture& picture) {
  const Image& color = picture.color;
  const std::size_t values = picture.halves.empty() ? color.pixels.size() : picture.halves.size();
  if (color.width < 1 || color.height < 1 || color.channels != 4 || color.size() != picture.data_window.size() ||
      values != static_cast<std::size_t>(color.width) * static_cast<std::size_t>(color.height) * 4)
    return Error{ErrorKind::other, "the picture's pixels do not cover its data window"};
  if (picture.display_window.width < 1 || picture.display_window.height < 1)
    return Error{ErrorKind::other, "the picture's display window is empty"};
  return {};
}

}  // namespace

bool has_transparency(const Picture& picture) {
  if (!picture.has_alpha) return false;
  std::vector<float> memory;
  for (int y = 0; y < picture.color.height; ++y) {
    const float* row = color_row(picture, y, memory);
    for (int x = 0; x < picture.color.width; ++x)
      if (row[4 * x + 3] < 1) return true;
  }
  return false;
}

std::optional<DisplayCodes> display_codes(const fs::path& file, const WriteOptions& options, bool has_alpha,
                                          const FileFacts* facts) {
  const auto format = output_format(file, options);
  if (!format || sample_type(**format, options, facts) != SampleType::uint8) return std::nullopt;
  if (stored_space(**format, options, SampleType::uint8)) return std::nullopt;
  return DisplayCodes{.straight_alpha = has_alpha && (*format)->alpha, .dither = options.dither.value_or(true)};
}

std::uint64_t write_bytes(const fs::path& file, const WriteOptions& options, Size size, bool has_alpha,
                          const FileFacts* facts) {
  const auto format = output_format(file, options);
  const bool beside = options.keep_layers && facts && facts->primaries;
  if (format && (*format)->kind == OutputKind::exr && (options.space || beside))
    return static_cast<std::uint64_t>(size.area()) * 4 * sizeof(float);  // see in_primaries
  if (!format || (*format)->kind != OutputKind::png) return 0;
  constexpr std::uint64_t kCopies = 2;  // filtered, and packed
  const std::uint64_t sample = sample_type(**format, options, facts) == SampleType::uint8 ? 1 : 2;
  return static_cast<std::uint64_t>(size.area()) * (has_alpha ? 4 : 3) * sample * kCopies;
}

Result<void> check_output(const fs::path& file, const WriteOptions& options) {
  AFTERGLOW_CHECK(check_format(file, options));
  AFTERGLOW_CHECK(check_place(file));
  return check_replaceable(file);
}

Result<void> check_extension(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  std::vector<std::string> known = picture_extensions();
  std::ranges::move(video_extensions(), std::back_inserter(known));
  return std::ranges::find(known, extension) != known.end() ? Result<void>() : unknown_format(file, known);
}

Result<void> check_format(const fs::path& file, const WriteOptions& options) {
  AFTERGLOW_TRY([[maybe_unused]] const OutputFormat* format, output_format(file, options));
  return {};
}

Result<void> check_place(const fs::path& file) {
  const auto refuse = [&](const std::string& why) { return Error{ErrorKind::io, why, file.string()}; };
  const fs::path target = behind_links(file);
  std::error_code ec;
  const fs::file_status status = fs::status(target, ec);
  if (fs::is_directory(status)) return refuse("is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) return refuse("is not a regular file");
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const fs::file_status folder_status = fs::status(folder, ec);
  if (!fs::exists(folder_status)) return refuse(fmt::format("its folder '{}' does not exist", folder.string()));
  if (!fs::is_directory(folder_status)) return refuse(fmt::format("'{}' is not a folder", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    return refuse(fmt::format("its folder '{}' cannot be written to: {}", folder.string(), std::strerror(errno)));
  return {};
}

Result<std::string> picture_bytes(const Picture& picture, const std::string& extension, const WriteOptions& options,
                                  Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const OutputFormat* format, output_format("-." + extension, options));
  AFTERGLOW_CHECK(check_picture(picture));
  try {
    OutputFile out(::memfd_create("afterglow", MFD_CLOEXEC));
    if (!out.failure()) AFTERGLOW_CHECK(write_format(picture, *format, out, "-." + extension, options, diagnostics));
    std::string bytes(out.size(), '\0');
    out.seek(0);
    if (out.read(bytes.data(), bytes.size())) return bytes;
    AFTERGLOW_CHECK(out.close());
    return Error{ErrorKind::io, "cannot be written: a file in memory failed"};
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be written: " + exception_text(error)};
  }
}

namespace {

/// Of videos with more than 40 frames a second.
void tell_of_time_code(const Picture& picture, const fs::path& file, Diagnostics& diagnostics) {
  const std::string extension = lower(file.extension().string());
  if (!picture.facts || (extension != ".exr" && extension != ".dpx")) return;
  const MetadataValue* code = find_metadata(picture.facts->metadata, kTimeCodeName);
  const std::string text = code ? metadata_text(*code) : "";
  if (!is_time_code(text) || time_code_of(text)) return;
  diagnostics.warn_once("time code", fmt::format("{}: the time code {} is left out: EXR and DPX hold frame numbers up "
                                                 "to 39; PNG and videos hold all",
                                                 file.string(), text));
}

/// Codes that a file has no words for, or the wrong ones.
void tell_of_space(const Picture& picture, const OutputFormat& format, const WriteOptions& options,
                   const fs::path& file, Diagnostics& diagnostics) {
  const StripForm form = strip_form(picture, format, options);
  if (!is_integer(form.type)) return;
  const std::string extension = lower(file.extension().string());
  const std::string what = form.space ? fmt::format("'{}'", form.space->name()) : "codes of a view";
  if (extension == ".jp2" && (form.space || form.view)) {
    diagnostics.warn_once("space of jp2", fmt::format("{}: holds {} and says that it is sRGB, as all JPEG 2000 files "
                                                      "that are written: tell the next program what it reads",
                                                      file.string(), what));
  } else if (form.space && must_be_told(*form.space) && format.kind != OutputKind::png) {
    diagnostics.warn_once(
        "space untold",
        fmt::format("{}: does not say that it holds {}: programs take it for sRGB until they are told; PNG says it",
                    file.string(), what));
  }
}

}  // namespace

Result<void> write_picture(const Picture& picture, const fs::path& file, const WriteOptions& options,
                           Diagnostics& diagnostics, std::string* stamp) {
  AFTERGLOW_CHECK(check_output(file, options));
  AFTERGLOW_TRY(const OutputFormat* format, output_format(file, options));
  Diagnostics named([&](Severity severity, const std::string& message) {
    const std::string text = fmt::format("{}: {}", file.string(), message);
    severity == Severity::warning ? diagnostics.warn(text) : diagnostics.note(text);
  });
  tell_of_time_code(picture, file, diagnostics);
  tell_of_space(picture, *format, options, file, diagnostics);
  try {
    AFTERGLOW_CHECK(check_picture(picture));
    Temporary temporary(file);
    if (auto written = write_checked(picture, *format, temporary.path(), file.filename().string(), options, named);
        !written) {
      Error error = std::move(written).error();
      error.file = file.string();  // not the temporary name
      return error;
    }
    const FileTime time;
    if (stamp) *stamp = file_stamp(temporary.path());
    return temporary.commit();
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", exception_text(error)), file.string()};
  }
}

}  // namespace afterglow
