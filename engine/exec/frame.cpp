#include "exec/frame.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>

#include "exec/barriers.h"
#include "exec/brightest.h"
#include "exec/convert.h"
#include "exec/frame_image.h"
#include "exec/host_input.h"
#include "exec/kernel_timer.h"
#include "exec/staging.h"
#include "exec/submit.h"
#include "gpu/error.h"

namespace afterglow {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The layout in which the program reads an input.
VkImageLayout input_layout(const Program& program, const std::string& name) {
  return name == "source" ? program.source_layout() : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
}

StagedImage staged(const FrameImage& image) {
  return {image.image.get(), image.image.desc().format, image.image.desc().size};
}

}  // namespace

struct FrameRunner::State {
  State(Device& device_in, std::uint64_t max_memory_in, bool direct_in)
      : device(device_in), max_memory(max_memory_in), direct(direct_in), staging(device_in), timer(device_in) {}

  Device& device;
  std::uint64_t max_memory;
  bool direct;
  std::map<std::string, FrameImage> inputs;
  FrameImage result;
  Staging staging;
  KernelTimer timer;
  Submitter submitter;  // last: it waits before the images go
  int images = 0;

  Result<void> prepare(const Program& program, const std::map<std::string, HostImage>& host);
  Result<void> make_image(FrameImage& image, const ImageDesc& desc, HostAccess access);
  Result<std::uint64_t> upload(FrameImage& image, const HostImage& host, Brightest* brightest);
  Result<std::uint64_t> download(HostResult& out);
  Result<void> bind(Program& program);
  void before(const Program& program, VkCommandBuffer commands);
  void after(VkCommandBuffer commands);
  Result<void> execute(Program& program, KernelTiming timing, FrameTimes& times);
};

FrameRunner::FrameRunner(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRunner::~FrameRunner() = default;

Result<std::unique_ptr<FrameRunner>> FrameRunner::create(Device& device, std::uint64_t max_memory, bool direct) {
  auto state = std::make_unique<State>(device, max_memory, direct && device.is_cpu());
  AFTERGLOW_TRY(state->submitter, Submitter::create(device));
  return std::unique_ptr<FrameRunner>(new FrameRunner(std::move(state)));
}

Result<void> FrameRunner::State::make_image(FrameImage& image, const ImageDesc& desc, HostAccess access) {
  if (image.fits(desc)) return {};
  image = {};  // before the new one is made: the two need not exist at once
  AFTERGLOW_TRY(image, FrameImage::create(device, desc, direct ? access : HostAccess::none));
  ++images;
  return {};
}

/// Images for this program and these inputs; those that are there and fit stay.
Result<void> FrameRunner::State::prepare(const Program& program, const std::map<std::string, HostImage>& host) {
  const Graph& graph = program.graph();
  const auto wanted = inputs_of(graph);
  std::map<std::string, ImageDesc> descs;
  for (const auto& [name, id] : wanted) {
    AFTERGLOW_CHECK(check_input(graph, name, id, host));
    descs[name] = {.name = name,
                   .size = graph.images[id].size,
                   .format = input_format(name, host.at(name), program.storage_format()),
                   .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    if (input_layout(program, name) == VK_IMAGE_LAYOUT_GENERAL) descs[name].usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  }
  const ImageDesc result_desc{.name = "result",
                              .size = graph.images[graph.result].size,
                              .format = program.storage_format(),
                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};

  const auto bytes = [](const ImageDesc& d) {
    return static_cast<std::uint64_t>(d.size.area()) * bytes_per_pixel(d.format);
  };
  std::uint64_t total = program.memory().arena + bytes(result_desc);
  for (const auto& [name, desc] : descs) total += bytes(desc);
  if (!direct) {
    total += 2 * Staging::bytes({VK_NULL_HANDLE, result_desc.format, result_desc.size});
  }
  if (total > max_memory) {
    return Error{ErrorKind::io,
                 fmt::format("the frame needs {} of device memory, more than the {} allowed (--max-memory)",
                             bytes_text(total), bytes_text(max_memory))};
  }
  std::erase_if(inputs, [&](const auto& entry) { return !wanted.contains(entry.first); });
  for (const auto& [name, desc] : descs) AFTERGLOW_CHECK(make_image(inputs[name], desc, HostAccess::write));
  return make_image(result, result_desc, HostAccess::read);
}

/// `brightest`: what to note the pixels in while they are at hand, or null.
Result<std::uint64_t> FrameRunner::State::upload(FrameImage& image, const HostImage& host, Brightest* brightest) {
  const ImageDesc& desc = image.image.desc();
  const auto pack = [&](int y, std::byte* to) {
    const float* row = host.pixels + static_cast<std::ptrdiff_t>(y) * desc.size.width * host.channels;
    if (brightest) brightest->add_row(row, host.channels, desc.size.width);
    return pack_row(row, host.channels, desc.size.width, desc.format, to);
  };
  if (!image.direct) {
    image.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return staging.upload(staged(image), pack);
  }
  const auto held =
      over_rows(desc.size.height, image.image.row_pitch(), [&](int y) { return pack(y, image.image.row(y)); });
  image.image.memory().flush();
  return held;
}

Result<std::uint64_t> FrameRunner::State::download(HostResult& out) {
  const auto [width, height] = result.image.desc().size;
  const VkFormat format = result.image.desc().format;
  const auto row_values = static_cast<std::size_t>(width) * 4;
  const auto values = row_values * static_cast<std::size_t>(height);
  const bool keep_alpha = out.keep_alpha && out.pixels.size() == values;
  if (out.pixels.size() != values) {
    std::vector<float>().swap(out.pixels);  // growing would keep the old ones while it copies them
    out.pixels.resize(values);
  }
  const auto unpack = [&](int y, const std::byte* from) {
    float* to = out.pixels.data() + row_values * static_cast<std::size_t>(y);
    return keep_alpha ? unpack_row_rgb(from, format, width, to) : unpack_row(from, format, width, to);
  };
  if (!result.direct) return staging.download(staged(result), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, unpack);
  result.image.memory().invalidate();
  return over_rows(height, result.image.row_pitch(), [&](int y) { return unpack(y, result.image.row(y)); });
}

Result<void> FrameRunner::State::bind(Program& program) {
  const auto binding = [](const FrameImage& image) {
    return ImageBinding{image.image.get(), image.image.view(), image.image.desc().format, image.image.desc().size};
  };
  std::map<std::string, ImageBinding> bindings;
  for (const auto& [name, image] : inputs) bindings[name] = binding(image);
  return program.bind(bindings, binding(result));
}

/// Into the layouts that Program::record wants.
void FrameRunner::State::before(const Program& program, VkCommandBuffer commands) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (auto& [name, image] : inputs) {
    const VkImageLayout wanted = input_layout(program, name);
    if (!image.direct && image.layout == wanted) continue;  // the upload has done it
    const auto stage = image.direct ? VK_PIPELINE_STAGE_2_HOST_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    const VkAccessFlags2 access = image.direct ? VK_ACCESS_2_HOST_WRITE_BIT : VK_ACCESS_2_NONE;
    barriers.push_back(image_barrier(image.image.get(), stage, access, image.layout,
                                     VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, reading_access(wanted), wanted));
    image.layout = wanted;
  }
  barriers.push_back(image_barrier(result.image.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                                   VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
  record_barriers(commands, barriers.data(), barriers.size());
}

/// Into the layout in which the CPU may touch pixels. Staged images stay as they are.
void FrameRunner::State::after(VkCommandBuffer commands) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (auto& [name, image] : inputs) {
    if (!image.direct) continue;
    barriers.push_back(image_barrier(image.image.get(), VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0, image.layout,
                                     VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT,
                                     VK_IMAGE_LAYOUT_GENERAL));
    image.layout = VK_IMAGE_LAYOUT_GENERAL;
  }
  if (result.direct) {
    barriers.push_back(image_barrier(result.image.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                     VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL));
  }
  record_barriers(commands, barriers.data(), barriers.size());
}

Result<void> FrameRunner::State::execute(Program& program, KernelTiming timing, FrameTimes& times) {
  const auto& kernels = program.plan().kernels;
  const bool separate = timing == KernelTiming::submissions;
  const bool stamps = timing == KernelTiming::timestamps && device.timestamps_mean_draws();
  VkQueryPool queries = VK_NULL_HANDLE;
  if (stamps) {
    AFTERGLOW_TRY(queries, timer.queries(kernels.size() + 1));
  }

  const auto start = Clock::now();
  auto done = submitter.submit([&](VkCommandBuffer commands) {
    before(program, commands);
    program.record(commands, -1, queries);
    if (!separate) after(commands);
  });
  if (done) done = submitter.wait();
  if (!done) return KernelTimer::blame(std::move(done).error(), program.plan());
  times.execute = milliseconds_since(start);
  if (stamps) {
    AFTERGLOW_TRY(times.kernels, timer.read(program.plan()));
  }
  if (!separate) return {};

  // Each kernel once more, alone: the same pixels again, since no input has changed.
  times.separate_submissions = true;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const auto begin = Clock::now();
    done = submitter.submit([&](VkCommandBuffer commands) { program.record(commands, static_cast<int>(i)); });
    if (done) done = submitter.wait();
    if (!done) {
      Error error = std::move(done).error();
      error.message += fmt::format(" in kernel '{}'", kernels[i].name);
      return error;
    }
    times.kernels.push_back({kernels[i].name, milliseconds_since(begin)});
  }
  AFTERGLOW_CHECK(submitter.submit([&](VkCommandBuffer commands) { after(commands); }));
  return submitter.wait();
}

Result<FrameTimes> FrameRunner::run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out,
                                    KernelTiming timing, const Choose& choose) {
  State& s = *state_;
  const Graph& graph = program.graph();
  FrameTimes times;
  out.clamped = 0;
  if (graph.result == graph.source) {
    AFTERGLOW_CHECK(check_input(graph, "source", graph.source, inputs));
    copy_source(inputs.at("source"), out.pixels);
    return times;
  }
  AFTERGLOW_CHECK(s.prepare(program, inputs));

  auto start = Clock::now();
  Brightest brightest;
  for (auto& [name, image] : s.inputs) {
    const bool looked_at = choose && name == "source";
    AFTERGLOW_TRY(const std::uint64_t held, s.upload(image, inputs.at(name), looked_at ? &brightest : nullptr));
    out.clamped += held;
  }
  times.upload = milliseconds_since(start);

  Program* chosen = &program;
  if (choose) {
    const bool half = program.storage_format() == VK_FORMAT_R16G16B16A16_SFLOAT;
    AFTERGLOW_TRY(chosen, choose(brightest.value(half ? Storage::fp16 : Storage::fp32)));
  }
  if (!chosen) {
    copy_source(inputs.at("source"), out.pixels);
    return times;
  }
  AFTERGLOW_CHECK(s.bind(*chosen));
  AFTERGLOW_CHECK(s.execute(*chosen, timing, times));

  start = Clock::now();
  AFTERGLOW_TRY(const std::uint64_t held, s.download(out));
  out.clamped += held;
  times.readback = milliseconds_since(start);
  return times;
}

Result<HostResult> FrameRunner::read_image(Program& program, ImageId image) {
  const auto found = program.transient(image);
  if (!found || !found->kept) {
    const auto& images = program.graph().images;
    const bool known = image >= 0 && image < static_cast<int>(images.size());
    return Error{ErrorKind::other,
                 fmt::format("the pixels of '{}' are not kept", known ? images[image].name : std::to_string(image))};
  }
  const auto [width, height] = found->binding.size;
  HostResult out;
  out.pixels.resize(static_cast<std::size_t>(found->binding.size.area()) * 4);
  const auto unpack = [&, w = width](int y, const std::byte* from) {
    return unpack_row(from, found->binding.format, w, out.pixels.data() + static_cast<std::ptrdiff_t>(y) * w * 4);
  };
  AFTERGLOW_TRY(out.clamped,
                state_->staging.download({found->binding.image, found->binding.format, found->binding.size},
                                         found->layout, unpack));
  return out;
}

FrameRunner::Counters FrameRunner::counters() const {
  return {.images = state_->images, .buffers = state_->staging.buffers() + state_->timer.pools()};
}

}  // namespace afterglow
