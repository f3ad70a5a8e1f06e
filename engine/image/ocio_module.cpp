// SPDX-License-Identifier: MIT
#include "image/ocio_module.h"

#include "core/module.h"

namespace afterglow {
namespace {

Result<const OcioModule*> load_ocio_module() {
  auto entry = load_module("afterglow_ocio.so", "afterglow_ocio_module");
  if (!entry) return Error{ErrorKind::io, "OpenColorIO cannot be used: " + entry.error().message};
  return reinterpret_cast<const OcioModule* (*)()>(*entry)();
}

}  // namespace

Result<const OcioModule*> ocio_module() {
  static const Result<const OcioModule*> module = load_ocio_module();
  return module;
}

Result<OcioSurvey> survey_ocio(const OcioRequest& request) {
  AFTERGLOW_TRY(const OcioModule* module, ocio_module());
  return module->survey(request);
}

Result<OcioShader> ocio_shader(const OcioRequest& request) {
  AFTERGLOW_TRY(const OcioModule* module, ocio_module());
  return module->shader(request);
}

std::string ocio_version() {
  const auto module = ocio_module();
  return module ? (*module)->version() : std::string();
}

Result<OcioFunction> ocio_function(const OcioRequest& request) {
  AFTERGLOW_TRY(const OcioModule* module, ocio_module());
  return module->function(request);
}

}  // namespace afterglow
