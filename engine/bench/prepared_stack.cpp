// SPDX-License-Identifier: MIT
#include "bench/prepared_stack.h"

#include <algorithm>

#include "graph/memory.h"

namespace afterglow::bench {
namespace {

constexpr int kPassRuns = 3;

std::vector<float> rgb_of(const std::vector<float>& rgba) {
  std::vector<float> out;
  out.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) out.insert(out.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return out;
}

/// Medians of the times of each kernel over several runs.
std::vector<KernelTime> medians(const std::vector<FrameTimes>& runs) {
  std::vector<KernelTime> out = runs.front().kernels;
  for (std::size_t k = 0; k < out.size(); ++k) {
    std::vector<double> samples;
    for (const auto& run : runs) samples.push_back(run.kernels[k].milliseconds);
    out[k].milliseconds = Spread::of(std::move(samples)).median;
  }
  return out;
}

bool is_opaque(const Image& image) {
  if (image.channels < 4) return true;
  for (int y = 0; y < image.height; ++y) {
    const float* row = image.at(0, y);
    for (int x = 0; x < image.width; ++x)
      if (row[static_cast<std::size_t>(x) * static_cast<std::size_t>(image.channels) + 3] != 1) return false;
  }
  return true;
}

}  // namespace

BuildContext context_of(const Picture& picture) {
  BuildContext context;
  context.size = picture.color.size();
  for (const auto& [name, image] : picture.auxiliary) context.auxiliary[name] = image.size();
  return context;
}

Result<PreparedStack> PreparedStack::create(Device& device, const std::filesystem::path& preset,
                                            const StackOptions& base, const Variant& variant, const Picture& picture,
                                            Diagnostics& diagnostics) {
  PreparedStack out;
  out.variant_ = variant;
  StackOptions options = base;
  options.choice = variant.choice;
  options.flag_non_finite = variant.check_finite;
  options.preset.overrides.insert(options.preset.overrides.end(), variant.overrides.begin(), variant.overrides.end());
  options.skip_idle = options.skip_idle && is_opaque(picture.color);  // or the program would take it for such
  AFTERGLOW_TRY(out.stack_, Stack::load(preset, options, diagnostics));
  out.stack_->use(device, true);
  AFTERGLOW_CHECK(out.stack_->prepare(context_of(picture), variant.encoding));
  return out;
}

PictureKind PreparedStack::picture_kind() const {
  const Program* program = stack_->program();
  if (!program) return {};
  return {program->storage_format(), program->result_format(), program->result_rows(), program->stores_result()};
}

Result<Point> PreparedStack::try_out(Device& device, const Picture& picture, bool passes, std::vector<float>& rgb) {
  Point point{
      .choice = execution_name(stack_->choice().execution), .label = variant_.label, .settings = variant_.settings};
  if (!runs()) {
    rgb = rgb_of(picture.color.pixels);
    return point;
  }
  const Program& program = *stack_->program();
  point.kernels = static_cast<int>(program.plan().kernels.size());
  point.image_memory = program.memory().arena;
  const Traffic traffic = traffic_of(program.graph(), program.plan(), program.config(), &program.parts());
  point.traffic = traffic.total;
  point.unavoidable = traffic.unavoidable;
  AFTERGLOW_TRY(const auto renderer, Renderer::create(device, {.max_memory = 64ull << 30}));
  std::map<std::string, HostImage> inputs{
      {"source", {picture.color.pixels.data(), picture.color.size(), picture.color.channels}}};
  for (const auto& [name, image] : picture.auxiliary)
    inputs[name] = {image.pixels.data(), image.size(), image.channels};

  HostResult result;
  std::vector<FrameTimes> runs;
  const KernelTiming timing = !passes                          ? KernelTiming::none
                              : device.timestamps_mean_draws() ? KernelTiming::timestamps
                                                               : KernelTiming::submissions;
  for (int i = 0; i <= (passes ? kPassRuns : 1); ++i) {
    AFTERGLOW_TRY(RenderRequest request, stack_->request(request_for(stack_->build(), variant_.encoding)));
    request.inputs = inputs;
    request.timing = timing;
    AFTERGLOW_TRY(FrameReport report, renderer->render(std::move(request), result));
    if (i > 0) runs.push_back(std::move(report.times));  // the first one also makes memory and finishes shaders
  }
  point.upload = runs.back().upload;
  point.read_back = runs.back().readback;
  point.passes = medians(runs);
  rgb = rgb_of(result.pixels);
  return point;
}

Result<void> PreparedStack::record(const Device& device, const DevicePicture& picture) {
  AFTERGLOW_CHECK(stack_->bind(picture.inputs(), picture.result()));
  const VkImageLayout layout = runs() ? stack_->program()->input_layout() : VK_IMAGE_LAYOUT_GENERAL;
  const auto framed = [&](VkCommandBuffer commands, const auto& record) {
    picture.before(commands, layout);
    record();
    picture.after(commands, layout);
  };
  // What is timed is a steady frame: what is made once has been made by a whole one.
  std::vector<bool> steady;
  if (runs()) steady = stack_->program()->plan().once;
  steady.flip();
  const bool any_once = std::ranges::find(steady, false) != steady.end();
  if (any_once) {
    AFTERGLOW_TRY(TimedWork whole, TimedWork::create(device, [&](VkCommandBuffer commands) {
                    framed(commands, [&] { stack_->program()->record(commands); });
                  }));
    AFTERGLOW_CHECK(whole.run());
  }
  AFTERGLOW_TRY(work_, TimedWork::create(device, [&](VkCommandBuffer commands) {
                  framed(commands, [&] {
                    if (any_once)
                      stack_->program()->record(commands, VK_NULL_HANDLE, steady);
                    else
                      stack_->record(commands);
                  });
                }));
  return {};
}

}  // namespace afterglow::bench
