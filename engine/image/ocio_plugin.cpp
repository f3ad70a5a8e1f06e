// SPDX-License-Identifier: MIT
// OpenColorIO's side of read_lut (a file becomes a chain of its transforms, each taken apart into a step) and of
// configurations.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <string_view>

#include "core/exception.h"
#include "core/module_shapes.h"
#include "core/text.h"
#include "image/lut_file.h"
#include "image/lut_taker.h"
#include "image/ocio_chain.h"
#include "image/ocio_glsl.h"
#include "image/ocio_module.h"

namespace afterglow {
namespace {

/// Its end counts: what is wrong stands behind what was tried.
std::string shortened(const std::string& message) {
  constexpr std::size_t kMost = 300;
  std::string out;
  for (const char c : message) {
    const bool blank = static_cast<unsigned char>(c) <= 0x20;
    if (!blank || (!out.empty() && out.back() != ' ')) out += blank ? ' ' : c;
  }
  if (out.size() > kMost) {
    std::size_t begin = out.size() - kMost;
    while (begin < out.size() && (static_cast<unsigned char>(out[begin]) & 0xc0) == 0x80) ++begin;
    out = "…" + out.substr(begin);
  }
  return trim(out);
}

/// OpenColorIO's reason in one line, at the file that it is about, with the line where it names one.
Error error_of(std::string file, std::string message) {
  constexpr std::string_view kTable = "The specified transform file '", kTableEnd = "' could not be loaded.",
                             kProfile = "Loading the OCIO profile '", kProfileEnd = "' failed. ";
  const auto cut = [&](std::string_view opening, std::string_view end) {  // what stands between them
    const std::size_t at = message.find(opening), begin = at + opening.size(), behind = message.find(end, at);
    if (at == std::string::npos || behind == std::string::npos || behind < begin) return std::string();
    std::string name = message.substr(begin, behind - begin);
    message.erase(0, behind + end.size());
    return name;
  };
  if (const std::string table = cut(kTable, kTableEnd); !table.empty()) file = table;
  cut(kProfile, kProfileEnd);
  if (const auto tried = message.find(" gave the error"); tried != std::string::npos)
    if (const auto colon = message.find(':', tried); colon != std::string::npos) message.erase(0, colon + 1);
  const std::string name = std::filesystem::path(file).filename().string();
  for (std::size_t at = message.find(file); at != std::string::npos; at = message.find(file, at + name.size()))
    message.replace(at, file.size(), name);
  int line = 0;
  if (const auto at = message.find("line"); at != std::string::npos)
    if (const auto digit = message.find_first_of("0123456789", at); digit != std::string::npos && digit < at + 8)
      line = std::atoi(message.c_str() + digit);
  return {ErrorKind::script, "OpenColorIO cannot read it: " + shortened(message), file, line};
}

std::mutex mutex;  // OpenColorIO's cache of files is one for all

Result<Lut> read(const std::filesystem::path& file, const std::string& correction) {
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);  // what it says comes back as an error
  try {
    OCIO::ClearAllCaches();  // it knows files by their names: one that was edited would stay as it was
    const auto config = OCIO::Config::CreateRaw();
    const auto transform = OCIO::FileTransform::Create();
    transform->setSrc(std::filesystem::absolute(file).c_str());
    // Of these, a CLF alone says itself how it wants to be read.
    const bool says = lower(file.extension().string()) == ".clf";
    transform->setInterpolation(says ? OCIO::INTERP_DEFAULT : OCIO::INTERP_TETRAHEDRAL);
    transform->setCCCId(correction.empty() ? "0" : correction.c_str());  // of a list, the first
    return LutTaker(config).take(*config->getProcessor(transform)->createGroupTransform());
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, file.string()};
  } catch (const std::exception& error) {
    return error_of(file.string(), exception_text(error));
  }
}

Result<OcioSurvey> survey(const OcioRequest& request) {
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  try {
    OCIO::ClearAllCaches();  // it remembers which files are not there
    const auto config = open_ocio(request);
    OcioSurvey out;
    out.files = ocio_files(*config, *ocio_chain(*config, request));
    for (int i = 0; i < config->getNumDisplays(); ++i) {
      OcioSurvey::Display& display = out.displays.emplace_back(OcioSurvey::Display{config->getDisplay(i), {}});
      for (int v = 0; v < config->getNumViews(display.name.c_str()); ++v)
        display.views.emplace_back(config->getView(display.name.c_str(), v));
    }
    return out;
  } catch (const OcioFault& wrong) {
    OcioSurvey out;
    out.fault = wrong.fault;
    return out;
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, request.config.string()};
  } catch (const std::exception& error) {
    return error_of(request.config.string(), exception_text(error));
  }
}

/// OpenColorIO reads those files that the survey told, and no others.
void check_files(const OCIO::Processor& processor, const std::vector<OcioSurvey::File>& told) {
  const auto metadata = processor.getProcessorMetadata();
  for (int i = 0; i < metadata->getNumFiles(); ++i) {
    const std::filesystem::path file = metadata->getFile(i);
    if (std::ranges::none_of(told, [&](const auto& known) { return known.path == file; }))
      throw Unsupported{fmt::format("reads {}, which nothing in it was seen to name", file.string())};
  }
}

/// What `make` makes of the request's configuration and processor.
template <class Made, class Make>
Result<Made> with_processor(const OcioRequest& request, const Make& make) {
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
  try {
    OCIO::ClearAllCaches();
    const auto config = open_ocio(request);
    const auto chain = ocio_chain(*config, request);
    const auto files = ocio_files(*config, *chain);
    const auto processor = config->getProcessor(chain);
    check_files(*processor, files);
    return make(*config, *processor);
  } catch (const OcioFault& wrong) {
    return Error{ErrorKind::script,       wrong.fault.key + ": " + wrong.fault.what,
                 request.config.string(), 0,
                 wrong.fault.allowed,     wrong.fault.nearest};
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, request.config.string()};
  } catch (const std::exception& error) {
    return error_of(request.config.string(), exception_text(error));
  }
}

Result<OcioShader> shader(const OcioRequest& request) {
  return with_processor<OcioShader>(
      request, [](const OCIO::Config&, const OCIO::Processor& processor) { return ocio_glsl(processor); });
}

Result<OcioFunction> function(const OcioRequest& request) {
  return with_processor<OcioFunction>(request, [&](const OCIO::Config& config, const OCIO::Processor& processor) {
    OcioFunction out;
    if (!request.to_space) {
      out.display = request.display.empty() ? config.getDefaultDisplay() : request.display;
      out.view = request.view.empty() ? config.getDefaultView(out.display.c_str()) : request.view;
    }
    const auto cpu = processor.getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
    out.apply = [cpu](float* rgb, std::size_t pixels) {
      OCIO::PackedImageDesc image(rgb, static_cast<long>(pixels), 1, 3);
      cpu->apply(image);
    };
    return out;
  });
}

std::string version() { return OCIO::GetVersion(); }

std::vector<std::string> extensions() {
  // No tables: profiles of devices, and collections that name further files.
  static constexpr std::array kOthers{"icc", "icm", "pf", "ctf", "look"};
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

extern "C" __attribute__((visibility("default"))) const afterglow::OcioModule* afterglow_ocio_module() {
  static constexpr afterglow::OcioModule module{&afterglow::read,   &afterglow::extensions, &afterglow::survey,
                                                &afterglow::shader, &afterglow::function,   &afterglow::version};
  return &module;
}

AFTERGLOW_MODULE_SHAPES
