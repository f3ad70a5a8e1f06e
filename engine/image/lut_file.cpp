// SPDX-License-Identifier: MIT
#include "image/lut_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "core/text.h"
#include "image/ocio_module.h"

namespace afterglow {
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
  return module->read(file, correction);
}

bool gives_unit(const Lut& loaded) {
  if (loaded.steps.empty()) return false;
  const LutStep& last = loaded.steps.back();
  if (last.kind != LutKind::table1d && last.kind != LutKind::table3d && last.kind != LutKind::table_half) return false;
  // Its numbers are all that is left of the image; what fills up rows is 0.
  const auto first = loaded.table.begin() + static_cast<std::ptrdiff_t>(last.row) * loaded.size.width * 4;
  return std::all_of(first, loaded.table.end(), [](float value) { return value >= 0.0f && value <= 1.0f; });
}

}  // namespace afterglow
