// OpenColorIO's side of read_lut: a file becomes a chain of its transforms, each taken apart into a step.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "core/exception.h"
#include "image/lut_file.h"
#include "image/lut_taker.h"
#include "image/ocio_view.h"

namespace afterglow {
namespace {

/// OpenColorIO's message in one line, with the line of the file where it names one.
Error error_of(const std::string& file, std::string message) {
  int line = 0;
  if (const auto at = message.find("line"); at != std::string::npos)
    if (const auto digit = message.find_first_of("0123456789", at); digit != std::string::npos && digit < at + 8)
      line = std::atoi(message.c_str() + digit);
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  if (message.size() > 300) message.resize(300);
  return {ErrorKind::script, "OpenColorIO cannot read it: " + message, file, line};
}

std::mutex mutex;  // OpenColorIO's cache of files is one for all

Result<Lut> read(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);  // what it says comes back as an error
  try {
    OCIO::ClearAllCaches();  // it knows files by their names: one that was edited would stay as it was
    const auto config = OCIO::Config::CreateRaw();
    const auto transform = OCIO::FileTransform::Create();
    transform->setSrc(std::filesystem::absolute(file).c_str());
    transform->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
    transform->setCCCId("0");  // of a list of corrections, the first
    return LutTaker(config).take(*config->getProcessor(transform)->createGroupTransform());
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, file.string()};
  } catch (const std::exception& error) {
    return error_of(file.string(), exception_text(error));
  }
}

Result<Lut> view(const OcioRequest& request) {
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  try {
    OCIO::ClearAllCaches();
    return lut_of_view(request);
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, request.config.string()};
  } catch (const std::exception& error) {
    return error_of(request.config.string(), exception_text(error));
  }
}

std::vector<std::string> extensions() {
  // No tables: profiles of devices, and collections that name further files.
  static constexpr std::array kOthers{"icc", "icm", "pf", "ctf", "ccc", "look"};
  std::vector<std::string> all;
  for (int i = 0; i < OCIO::FileTransform::GetNumFormats(); ++i) {
    const std::string extension = OCIO::FileTransform::GetFormatExtensionByIndex(i);
    if (std::find(kOthers.begin(), kOthers.end(), extension) == kOthers.end()) all.push_back(extension);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace
}  // namespace afterglow

extern "C" __attribute__((visibility("default"))) const afterglow::LutModule* afterglow_lut_module() {
  static constexpr afterglow::LutModule module{&afterglow::read, &afterglow::extensions, &afterglow::view};
  return &module;
}
