// SPDX-License-Identifier: MIT
#include "image/lut_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/file.h"
#include "core/text.h"
#include "image/memory_file.h"
#include "image/ocio_module.h"

namespace afterglow {
namespace {

/// A .cube as DaVinci Resolve writes it, without the title, which OpenColorIO knows in the other kind of .cube alone.
/// Empty: it is none that is to be read so.
std::string without_title(const std::string& text) {
  if (text.find("_INPUT_RANGE") == std::string::npos) return "";
  std::string out;
  bool titled = false;
  for (const std::string& line : split(text, '\n')) {
    const bool title = trim(line).starts_with("TITLE");
    titled = titled || title;
    out += (title ? "#" : line) + "\n";  // so that lines keep their numbers
  }
  return titled ? out : "";
}

/// As if it stood in the file.
Result<Lut> read_text(const OcioModule& module, const std::string& text, const std::filesystem::path& file,
                      const std::string& correction) {
  AFTERGLOW_TRY(const MemoryFile memory, MemoryFile::create());
  if (!(std::ofstream(memory.name(), std::ios::binary) << text).flush())
    return Error{ErrorKind::io, "there is no memory for its text", file.string()};
  auto table = module.read(memory.name(), correction);
  if (table) return table;
  Error error = std::move(table).error();
  error.file = file.string();
  return error;
}

}  // namespace

Result<Lut> read_lut(const std::filesystem::path& file, FileRecord* record, const std::string& correction) {
  const auto fail = [&](std::string what) { return Error{ErrorKind::script, std::move(what), file.string()}; };
  std::string extension = lower(file.extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  AFTERGLOW_TRY(const OcioModule* module, ocio_module());
  const std::vector<std::string> known = module->extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end())
    return Error{ErrorKind::script, fmt::format("'{}' is no format of look-up tables", extension),
                 file.string(),     0,
                 join(known),       nearest_name(extension, known)};
  auto text = read_file(file, kMostLutBytes, record);
  if (!text) return fail(text.error().message);
  AFTERGLOW_CHECK(check_table(*text, file, TableUse::of_look));
  // OpenColorIO puts variables of the environment into paths.
  if (file.string().find_first_of("$%") != std::string::npos)
    return fail("a path with '$' or '%' cannot be handed to OpenColorIO; rename the file or its folder");
  const std::string untitled = extension == "cube" ? without_title(*text) : "";
  return untitled.empty() ? module->read(file, correction) : read_text(*module, untitled, file, correction);
}

bool gives_unit(const Lut& loaded) {
  if (loaded.steps.empty()) return false;
  const LutStep& last = loaded.steps.back();
  if (last.kind != LutKind::table1d && last.kind != LutKind::table3d && last.kind != LutKind::table3d_linear &&
      last.kind != LutKind::table_half)
    return false;
  // Its numbers are all that is left of the image; what fills up rows is 0.
  const auto first = loaded.table.begin() + static_cast<std::ptrdiff_t>(last.row) * loaded.size.width * 4;
  return std::all_of(first, loaded.table.end(), [](float value) { return value >= 0.0f && value <= 1.0f; });
}

}  // namespace afterglow
