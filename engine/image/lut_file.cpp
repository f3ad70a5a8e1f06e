#include "image/lut_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "core/module.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxFile = 128u << 20;  // 129³ lines of 50 letters

/// OpenColorIO lives in a module: it takes longer to load than a frame takes to run.
Result<const LutModule*> lut_module() {
  static const Result<void*> entry = load_module("afterglow_ocio.so", "afterglow_lut_module");
  if (!entry) return Error{ErrorKind::io, "look-up tables cannot be read: " + entry.error().message};
  return reinterpret_cast<const LutModule* (*)()>(*entry)();
}

}  // namespace

Result<Lut> read_lut(const std::filesystem::path& file, FileRecord* record) {
  const auto fail = [&](std::string what) { return Error{ErrorKind::script, std::move(what), file.string()}; };
  std::string extension = lower(file.extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  AFTERGLOW_TRY(const LutModule* module, lut_module());
  const std::vector<std::string> known = module->extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end())
    return Error{ErrorKind::script, fmt::format("'{}' is no format of look-up tables", extension),
                 file.string(),     0,
                 join(known),       nearest_name(extension, known)};
  auto text = read_file(file, kMaxFile, record);
  if (!text) return fail(text.error().message);
  if (extension == "cube") AFTERGLOW_CHECK(check_cube(*text, file.string()));
  // Colour transforms that name further files: what a look may read is decided elsewhere.
  if (extension == "clf" && text->find("Reference") != std::string::npos)
    return fail("refers to another file, which is not supported");
  // OpenColorIO puts variables of the environment into paths.
  if (file.string().find_first_of("$%") != std::string::npos)
    return fail("a path with '$' or '%' cannot be handed to OpenColorIO; rename the file or its folder");
  return module->read(file);
}

Result<Lut> read_ocio(const OcioRequest& request) {
  AFTERGLOW_TRY(const LutModule* module, lut_module());
  std::error_code ec;
  if (!std::filesystem::is_regular_file(request.config, ec))
    return Error{ErrorKind::script, "there is no such OpenColorIO configuration", request.config.string()};
  return module->view(request);
}

}  // namespace afterglow
