// SPDX-License-Identifier: MIT
// What the opaque types of afterglow.h are.
#pragma once

#include <memory>

#include "api/backend.h"
#include "api/call.h"
#include "api/pixels.h"

struct afterglow_device {
  std::shared_ptr<afterglow::api::SharedDevice> shared;
};

struct afterglow_stack {
  std::unique_ptr<afterglow::api::Backend> backend;
  afterglow::api::MendedImages mended{};  ///< in the last frame
};

namespace afterglow::api {

/// A stack to work on. Errors: usage (null), device (it is of another process).
Result<Backend*> backend_of(const afterglow_stack* stack, const char* function);

/// The frame as the engine has it, `given` may be null. Errors: usage.
Result<BuildContext> context_of(const afterglow_frame* given, Size size);

/// Empty for all of it. Errors (usage): it is not within the picture.
Result<std::optional<Rect>> region_of(const afterglow_rect& given, Size size);

}  // namespace afterglow::api
