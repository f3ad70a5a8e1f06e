// SPDX-License-Identifier: MIT
// Stacks of the C interface: made, run, reloaded, asked.
#include <fmt/format.h>

#include <cmath>

#include "api/documents.h"
#include "api/handles.h"
#include "core/paths.h"

namespace afterglow::api {

Result<Backend*> backend_of(const afterglow_stack* stack, const char* function) {
  if (!stack) return usage(std::string(function) + ": stack is NULL");
  AFTERGLOW_CHECK(stack->backend->device().check_process());
  return stack->backend.get();
}

namespace {

/// Errors (usage): numbers that no frame has.
Result<void> check_frame(const afterglow_frame& frame) {
  const auto check = [](const char* name, double value, bool positive) -> Result<void> {
    if (std::isfinite(value) && (!positive || value > 0)) return {};
    Error error = usage(fmt::format("afterglow_frame: {} is {:g}", name, value));
    error.allowed = positive ? "finite numbers above 0" : "finite numbers";
    return error;
  };
  AFTERGLOW_CHECK(check("number", frame.number, false));
  AFTERGLOW_CHECK(check("fps", frame.fps, true));
  AFTERGLOW_CHECK(check("time", frame.time, false));
  AFTERGLOW_CHECK(check("step", frame.step, true));
  if (frame.has_position)
    for (const double coordinate : frame.position) AFTERGLOW_CHECK(check("position", coordinate, false));
  return {};
}

}  // namespace

Result<BuildContext> context_of(const afterglow_frame* given, Size size) {
  afterglow_frame frame = afterglow_frame_default();
  if (given) {
    AFTERGLOW_TRY(frame, take(given, frame, "afterglow_frame"));
  }
  AFTERGLOW_CHECK(check_frame(frame));
  BuildContext context;
  context.size = size;
  context.frame = frame.number;
  context.time = frame.time;
  context.fps = frame.fps;
  context.step = frame.step;
  context.restart = frame.restart;
  if (frame.has_position) context.position = Position{frame.position[0], frame.position[1], frame.position[2]};
  return context;
}

Result<std::optional<Rect>> region_of(const afterglow_rect& given, Size size) {
  if (given.width == 0) return std::optional<Rect>();
  const bool inside = given.x >= 0 && given.y >= 0 && given.width > 0 && given.height > 0 &&
                      given.width <= size.width - given.x && given.height <= size.height - given.y;
  if (!inside)
    return usage(fmt::format("the region {},{} {}×{} is not within the {}×{} pixels of the picture", given.x, given.y,
                             given.width, given.height, size.width, size.height));
  return std::optional<Rect>({given.x, given.y, given.width, given.height});
}

namespace {

Result<BackendOptions> options_of(const afterglow_stack_options& given) {
  if (!is_given(given.preset_file) && !is_given(given.preset_text))
    return usage("afterglow_stack_options: neither preset_file nor preset_text is given");
  if (is_given(given.preset_file) && given.preset_file.size == 0)
    return usage("afterglow_stack_options: preset_file is empty; allowed: a file, a pack or the name of a preset");
  if (given.follow && is_given(given.preset_text))
    return usage("afterglow_stack_options: a preset_text cannot be followed");
  if (given.path_count > 0 && !given.paths) return usage("afterglow_stack_options: paths is NULL");
  if (given.argument_count > 0 && !given.arguments) return usage("afterglow_stack_options: arguments is NULL");
  if (!(given.max_error >= 0)) return usage("afterglow_stack_options: max_error must not be negative");

  BackendOptions out;
  for (std::size_t i = 0; i < given.path_count; ++i) {
    AFTERGLOW_TRY(out.stack.preset.paths.emplace_back(), path_of(given.paths[i]));
  }
  for (std::size_t i = 0; i < given.argument_count; ++i) {
    AFTERGLOW_TRY(out.stack.preset.arguments.emplace_back(), parse_argument(text_of(given.arguments[i])));
  }
  AFTERGLOW_TRY(out.stack.preset.installation, path_of(given.installation));
  AFTERGLOW_TRY(const auto named, path_of(given.preset_file));
  if (is_given(given.preset_text)) {
    out.preset = is_given(given.preset_file) ? text_of(given.preset_file) : "preset.lua";
    if (out.preset.has_parent_path()) out.preset = named;  // else a name for messages alone
    out.stack.preset.text = text_of(given.preset_text);
  } else {
    AFTERGLOW_TRY(const std::filesystem::path found,
                  find_preset_file(text_of(given.preset_file), out.stack.preset.paths, out.stack.preset.installation));
    AFTERGLOW_TRY(out.preset, path_of(view(found.string())));
  }
  switch (given.precision) {
    case AFTERGLOW_PRECISION_AUTOMATIC:
      break;
    case AFTERGLOW_PRECISION_FP32:
      out.stack.precision = Precision::fp32;
      break;
    case AFTERGLOW_PRECISION_FP16:
      out.stack.precision = Precision::fp16;
      break;
    default:
      return usage("afterglow_stack_options: unknown precision");
  }
  if (given.use != AFTERGLOW_USE_HOST_MEMORY && given.use != AFTERGLOW_USE_COMMANDS)
    return usage("afterglow_stack_options: unknown use");
  if (given.max_error > 0) out.stack.max_error = given.max_error;
  if (given.max_memory > 0) out.stack.max_memory = given.max_memory;
  AFTERGLOW_TRY(out.stack.calibration, path_of(given.calibration));
  out.stack.reference = given.reference;
  out.commands = given.use == AFTERGLOW_USE_COMMANDS;
  out.follow = given.follow;
  out.time_kernels = given.time_kernels;
  out.message = sink_of(given.message, given.user);
  if (given.wake)
    out.wake = [wake = given.wake, user = given.user] {
      const HostLocale as_usual;
      wake(user);
    };
  return out;
}

/// Of each image once.
void tell_what_was_mended(const MendedImages& mended, Diagnostics& diagnostics) {
  const auto tell = [&](ImageRole role, const char* what) {
    if (const std::uint64_t count = mended[role]) diagnostics.warn_once(what, fmt::format(fmt::runtime(what), count));
  };
  tell(ImageRole::color, "the source has {} samples that are not finite or negative; they were mended");
  tell(ImageRole::depth, "image 'depth' has {} pixels that are not finite; they count as far away");
  tell(ImageRole::normal, "image 'normal' has {} pixels that are not finite; they count as without a normal");
  tell(ImageRole::motion, "image 'motion' has {} pixels that are not finite; they count as at rest");
}

struct Input {
  const char* name;
  const afterglow_image* image;
  ImageRole role;
};

Result<void> run(afterglow_stack& stack, const afterglow_run_info& info) {
  Backend& backend = *stack.backend;
  if (backend.options().commands)
    return usage(
        "afterglow_stack_run: the stack was made with AFTERGLOW_USE_COMMANDS; allowed: afterglow_stack_record");
  stack.mended.clear();
  AFTERGLOW_TRY(const Pixels source, check_image(info.source, ImageRole::color, "source"));
  AFTERGLOW_TRY(const Pixels result, check_image(info.result, ImageRole::color, "result"));
  const auto same_size = [&](const Pixels& image, const char* name) -> Result<void> {
    if (image.size == source.size) return {};
    return usage(fmt::format("image '{}' has {}×{} pixels, the source {}×{}", name, image.size.width, image.size.height,
                             source.size.width, source.size.height));
  };
  AFTERGLOW_CHECK(same_size(result, "result"));

  Shape shape;
  AFTERGLOW_TRY(shape.context, context_of(info.frame, source.size));
  AFTERGLOW_TRY(shape.region, region_of(info.region, source.size));
  const bool keeps_negative = backend.preset().keeps_negative().value_or(false);
  std::map<std::string, HostImage> inputs{
      {"source", color_image(source, keeps_negative, stack.mended[ImageRole::color])}};
  for (const Input& input :
       {Input{"depth", &info.depth, ImageRole::depth}, Input{"normal", &info.normal, ImageRole::normal},
        Input{"motion", &info.motion, ImageRole::motion}}) {
    if (!input.image->data) continue;
    AFTERGLOW_TRY(const Pixels pixels, check_image(*input.image, input.role, input.name));
    AFTERGLOW_CHECK(same_size(pixels, input.name));
    inputs[input.name] = auxiliary_image(pixels, input.role, stack.mended[input.role]);
    shape.context.auxiliary[input.name] = pixels.size;
  }
  if (result.samples == AFTERGLOW_UINT8)
    shape.encoding = DisplayEncoding{.straight_alpha = result.channels == 4, .dither = info.dither};

  HostResult rows = result_rows({.to = result,
                                 .source = source,
                                 .region = shape.region.value_or(Rect{0, 0, source.size.width, source.size.height}),
                                 .dither = info.dither});
  AFTERGLOW_CHECK(backend.run(shape, inputs, rows));
  tell_what_was_mended(stack.mended, backend.diagnostics());
  return {};
}

}  // namespace
}  // namespace afterglow::api

using namespace afterglow;
using namespace afterglow::api;

afterglow_error* afterglow_stack_create(afterglow_device* device, const afterglow_stack_options* options,
                                        afterglow_stack** out) {
  return call([&]() -> Result<void> {
    if (!out) return usage("afterglow_stack_create: out is NULL");
    *out = nullptr;
    if (!device) return usage("afterglow_stack_create: device is NULL");
    AFTERGLOW_CHECK(device->shared->check_process());
    AFTERGLOW_TRY(const auto given, take(options, afterglow_stack_options_default(), "afterglow_stack_options"));
    AFTERGLOW_TRY(const BackendOptions wanted, options_of(given));
    AFTERGLOW_TRY(auto backend, Backend::open(device->shared, wanted));
    *out = new afterglow_stack{std::move(backend)};
    return {};
  });
}

void afterglow_stack_free(afterglow_stack* stack) {
  if (stack && stack->backend->device().is_of_this_process()) delete stack;
}

afterglow_error* afterglow_stack_run(afterglow_stack* stack, const afterglow_run_info* info) {
  return call([&]() -> Result<void> {
    AFTERGLOW_CHECK(backend_of(stack, "afterglow_stack_run"));
    AFTERGLOW_TRY(const auto given, take(info, afterglow_run_info_default(), "afterglow_run_info"));
    return run(*stack, given);
  });
}

afterglow_error* afterglow_stack_prepare(afterglow_stack* stack, const afterglow_shape* shape,
                                         const afterglow_frame* frame) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_prepare"));
    AFTERGLOW_TRY(const auto given, take(shape, afterglow_shape_default(), "afterglow_shape"));
    const Size size{given.width, given.height};
    if (auto fits = check_size(size); !fits) return usage("afterglow_shape: " + fits.error().message);
    Shape wanted;
    AFTERGLOW_TRY(wanted.context, context_of(frame, size));
    AFTERGLOW_TRY(wanted.region, region_of(given.region, size));
    if (given.depth) wanted.context.auxiliary["depth"] = size;
    if (given.normal) wanted.context.auxiliary["normal"] = size;
    if (given.motion) wanted.context.auxiliary["motion"] = size;
    if (given.display_codes)
      wanted.encoding = DisplayEncoding{.straight_alpha = given.straight_alpha, .dither = given.dither};
    return backend->prepare(wanted);
  });
}

bool afterglow_stack_runs(const afterglow_stack* stack) {
  return stack && stack->backend->prepared() && stack->backend->runs();
}

void afterglow_stack_reset_history(afterglow_stack* stack) {
  if (const auto backend = backend_of(stack, "afterglow_stack_reset_history")) (*backend)->reset_histories();
}

afterglow_error* afterglow_stack_update(afterglow_stack* stack, bool* changed) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_update"));
    if (changed) *changed = false;
    AFTERGLOW_TRY(const bool taken, backend->update());
    if (changed) *changed = taken;
    return {};
  });
}

afterglow_error* afterglow_stack_reload(afterglow_stack* stack, afterglow_string preset_text) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_reload"));
    if (!is_given(preset_text)) return backend->reload({});
    if (backend->options().follow) return usage("afterglow_stack_reload: a stack that follows its files takes no text");
    return backend->reload(text_of(preset_text));
  });
}

afterglow_error* afterglow_stack_explain(const afterglow_stack* stack, afterglow_text** out) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_explain"));
    return give(explain_document(*backend), out, "afterglow_stack_explain");
  });
}

afterglow_error* afterglow_stack_report(const afterglow_stack* stack, afterglow_text** out) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_report"));
    return give(report_document(backend->report(), stack->mended.sum()), out, "afterglow_stack_report");
  });
}
