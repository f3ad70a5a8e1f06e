#include "exec/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

ImageDesc result_desc_of(const Program& program) {
  return {.name = "result",
          .size = program.graph().images[program.graph().result].size,
          .format = program.result_format(),
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
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
  std::map<int, FrameImage> other_results;  ///< by rows: programs that take turns may write different numbers of them

  /// What an input holds.
  struct Held {
    std::optional<Hash> content;
    Rect part;
    std::uint64_t version = 0;  ///< another one for other pixels
    std::uint64_t clamped = 0;
    std::optional<float> brightest;
  };
  std::map<std::string, Held> held;
  std::uint64_t versions = 0;
  std::map<std::uint64_t, std::map<std::string, std::uint64_t>> ran_with;  ///< program → versions of its inputs
  Staging staging;
  KernelTimer timer;
  /// What the command buffer holds and what it needs to be so again.
  struct Recorded {
    std::uint64_t program = 0;
    std::vector<bool> run;
    std::vector<VkImage> images;
    std::vector<VkImageLayout> layouts;  ///< of the inputs, before and after
    int bindings = 0;
    friend bool operator==(const Recorded&, const Recorded&) = default;
  };
  std::array<std::optional<Recorded>, 2> recorded;  ///< by Program::recording
  Submitter submitter;  // last: it waits before the images go
  /// What a program is bound to: the images, and its own count then.
  struct Bound {
    std::uint64_t program = 0;
    std::vector<VkImage> images;
    int bindings = 0;
    friend bool operator==(const Bound&, const Bound&) = default;
  };
  std::optional<Bound> bound;
  int images = 0;

  Result<void> prepare(const Program& program, const std::map<std::string, HostImage>& host);
  Result<void> make_image(FrameImage& image, const ImageDesc& desc, HostAccess access, int rows = 1);
  Result<std::uint64_t> upload(FrameImage& image, const HostImage& host, const Rect& part, Brightest* brightest);
  Result<void> upload_changed(const Program& program, const std::map<std::string, HostImage>& host, bool look,
                              HostResult& out);
  Result<void> take_result(const ImageDesc& desc, int rows);
  std::vector<bool> kernels_to_run(const Program& program) const;
  void has_run(Program& program);
  Result<std::uint64_t> download(const Rect& part, HostResult& out);
  Result<std::uint64_t> over_result_rows(const Rect& part,
                                         const std::function<std::uint64_t(int y, const std::byte* from)>& row);
  Result<void> bind(Program& program);
  /// The layout in which the result is drawn, and every VkImage of it: itself and its targets by rows.
  VkImageLayout result_layout() const {
    return result.rows.rows() > 1 ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  }
  std::vector<VkImage> result_images() const;
  void before(const Program& program, VkCommandBuffer commands);
  void after(VkCommandBuffer commands);
  Result<void> execute(Program& program, const std::vector<bool>& run, KernelTiming timing, FrameTimes& times);
};

FrameRunner::FrameRunner(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRunner::~FrameRunner() = default;

Result<std::unique_ptr<FrameRunner>> FrameRunner::create(Device& device, std::uint64_t max_memory, bool direct) {
  auto state = std::make_unique<State>(device, max_memory, direct && device.is_cpu());
  AFTERGLOW_TRY(state->submitter, Submitter::create(device));
  return std::unique_ptr<FrameRunner>(new FrameRunner(std::move(state)));
}

Result<void> FrameRunner::State::make_image(FrameImage& image, const ImageDesc& desc, HostAccess access, int rows) {
  if (image.fits(desc, rows)) return {};
  image = {};  // before the new one is made: the two need not exist at once
  AFTERGLOW_TRY(image, FrameImage::create(device, desc, direct ? access : HostAccess::none, rows));
  recorded = {}, bound.reset();  // a new image may have the handle of one that is gone
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
  const ImageDesc result_desc = result_desc_of(program);

  const auto bytes = [](const ImageDesc& d) {
    return static_cast<std::uint64_t>(d.size.area()) * bytes_per_pixel(d.format);
  };
  std::uint64_t total = program.memory().arena + program.memory().histories + bytes(result_desc);
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
  std::erase_if(held, [&](const auto& entry) { return !wanted.contains(entry.first); });
  for (const auto& [name, desc] : descs) {
    if (!inputs[name].fits(desc)) held.erase(name);
    AFTERGLOW_CHECK(make_image(inputs[name], desc, HostAccess::write));
  }
  return take_result(result_desc, program.result_rows());
}

/// The result image for programs that write so many rows at a time; those for others stay.
Result<void> FrameRunner::State::take_result(const ImageDesc& desc, int rows) {
  std::erase_if(other_results, [&](const auto& other) { return !other.second.fits(desc, other.first); });
  if (result.fits(desc, rows)) return {};
  const int has = std::max(result.rows.rows(), 1);
  if (has != rows && result.fits(desc, has)) {
    other_results[has] = std::move(result);
    result = std::move(other_results[rows]);
    other_results.erase(rows);
  }
  return make_image(result, desc, HostAccess::read, rows);
}

/// The rows of `part`; the others hold anything. `brightest`: what to note pixels in while they are at hand, or null.
Result<std::uint64_t> FrameRunner::State::upload(FrameImage& image, const HostImage& host, const Rect& part,
                                                 Brightest* brightest) {
  const ImageDesc& desc = image.image.desc();
  const auto pack = [&](int y, std::byte* to) -> std::uint64_t {
    if (y < part.y || y >= part.y + part.height) return 0;
    const float* row = host.pixels + static_cast<std::ptrdiff_t>(y) * desc.size.width * host.channels;
    if (brightest) brightest->add_row(row, host.channels, desc.size.width);
    return pack_row(row, host.channels, desc.size.width, desc.format, to);
  };
  if (!image.direct) {
    image.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return staging.upload(staged(image), pack);
  }
  const auto clamped = over_rows(part.height, image.image.row_pitch(),
                                 [&](int y) { return pack(part.y + y, image.image.row(part.y + y)); });
  image.image.memory().flush();
  return clamped;
}

/// Every input that may hold other pixels than those it is given. `look`: find out how bright the source is.
Result<void> FrameRunner::State::upload_changed(const Program& program, const std::map<std::string, HostImage>& host,
                                                bool look, HostResult& out) {
  const bool half = program.storage_format() == VK_FORMAT_R16G16B16A16_SFLOAT;
  for (const auto& [name, id] : inputs_of(program.graph())) {
    const HostImage& given = host.at(name);
    const Rect& part = program.parts().images[id];
    const bool look_here = look && name == "source";
    Held& known = held[name];
    const bool same = given.content && known.content == given.content && known.part == part;
    if (!same || (look_here && !known.brightest)) {
      Brightest brightest;
      known = {.content = {}, .part = part, .version = ++versions, .clamped = 0, .brightest = {}};
      AFTERGLOW_TRY(known.clamped, upload(inputs.at(name), given, part, look_here ? &brightest : nullptr));
      known.content = given.content;
      if (look_here) known.brightest = brightest.value(half ? Storage::fp16 : Storage::fp32);
    }
    out.clamped += known.clamped;
  }
  return {};
}

/// What has to run after the uploads.
std::vector<bool> FrameRunner::State::kernels_to_run(const Program& program) const {
  const auto last = ran_with.find(program.id());
  std::vector<ImageId> changed;
  for (const auto& [name, id] : inputs_of(program.graph())) {
    const bool same =
        last != ran_with.end() && last->second.contains(name) && last->second.at(name) == held.at(name).version;
    if (!same) changed.push_back(id);
  }
  return program.kernels_to_run(changed, result.writer != program.id());
}

void FrameRunner::State::has_run(Program& program) {
  constexpr std::size_t kMostRemembered = 64;  // programs are few; those that are gone are not worth more than this
  program.up_to_date();
  result.writer = program.id();
  if (ran_with.size() >= kMostRemembered) ran_with.clear();
  auto& versions_of = ran_with[program.id()];
  for (const auto& [name, input] : held) versions_of[name] = input.version;
}

/// Calls `row` for every row of that part of the result, with its first pixel there, and sums up what it returns.
Result<std::uint64_t> FrameRunner::State::over_result_rows(
    const Rect& part, const std::function<std::uint64_t(int y, const std::byte* from)>& row) {
  const std::size_t left = static_cast<std::size_t>(part.x) * bytes_per_pixel(result.image.desc().format);
  const auto inside = [&](int y, const std::byte* from) -> std::uint64_t {
    return y < part.y || y >= part.y + part.height ? 0 : row(y, from + left);
  };
  if (!result.direct) return staging.download(staged(result), result_layout(), inside);
  result.image.memory().invalidate();
  return over_rows(part.height, result.image.row_pitch(),
                   [&](int y) { return row(part.y + y, result.image.row(part.y + y) + left); });
}

Result<std::uint64_t> FrameRunner::State::download(const Rect& part, HostResult& out) {
  const auto [width, height] = result.image.desc().size;
  const VkFormat format = result.image.desc().format;
  const auto row_values = static_cast<std::size_t>(width) * 4;
  if (format == VK_FORMAT_R8G8B8A8_UNORM) {
    out.codes.resize(row_values * static_cast<std::size_t>(height));
    return over_result_rows(part, [&](int y, const std::byte* from) {
      std::memcpy(out.codes.data() + row_values * static_cast<std::size_t>(y) + static_cast<std::ptrdiff_t>(part.x) * 4,
                  from, static_cast<std::size_t>(part.width) * 4);
      return std::uint64_t{0};
    });
  }
  const auto values = row_values * static_cast<std::size_t>(height);
  const bool keep_alpha = out.keep_alpha && out.pixels.size() == values;
  if (out.pixels.size() != values) {
    std::vector<float>().swap(out.pixels);  // growing would keep the old ones while it copies them
    out.pixels.resize(values);
  }
  const auto unpack = [&](int y, const std::byte* from) {
    float* to = out.pixels.data() + row_values * static_cast<std::size_t>(y) + static_cast<std::ptrdiff_t>(part.x) * 4;
    return keep_alpha ? unpack_row_rgb(from, format, part.width, to) : unpack_row(from, format, part.width, to);
  };
  return over_result_rows(part, unpack);
}

Result<void> FrameRunner::State::bind(Program& program) {
  const auto binding = [](const FrameImage& image) {
    return ImageBinding{image.image.get(), image.image.view(), image.image.desc().format, image.image.desc().size,
                        image.rows.views()};
  };
  std::map<std::string, ImageBinding> bindings;
  for (const auto& [name, image] : inputs) bindings[name] = binding(image);
  return program.bind(bindings, binding(result));
}

std::vector<VkImage> FrameRunner::State::result_images() const {
  std::vector<VkImage> all{result.image.get()};
  for (int k = 0; k < result.rows.rows(); ++k) all.push_back(result.rows.image(k));
  return all;
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
  for (const VkImage image : result_images()) {
    barriers.push_back(image_barrier(image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                                     VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, result_layout()));
  }
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
    for (const VkImage image : result_images()) {
      barriers.push_back(image_barrier(
          image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
          result_layout(), VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL));
    }
  }
  record_barriers(commands, barriers.data(), barriers.size());
}

Result<void> FrameRunner::State::execute(Program& program, const std::vector<bool>& run, KernelTiming timing,
                                         FrameTimes& times) {
  const auto& kernels = program.plan().kernels;
  const bool separate = timing == KernelTiming::submissions;
  const bool stamps = timing == KernelTiming::timestamps && device.timestamps_mean_draws();
  VkQueryPool queries = VK_NULL_HANDLE;
  if (stamps) {
    AFTERGLOW_TRY(queries, timer.queries(kernels.size() + 1));
  }

  Recorded wanted{.program = program.id(), .run = run, .images = result_images(), .layouts = {}, .bindings = {}};
  for (const auto& [name, image] : inputs) {
    wanted.images.push_back(image.image.get());
    wanted.layouts.push_back(image.layout);
  }
  wanted.bindings = program.bindings();
  const bool unlike = program.recording() == Program::kUnlikeOthers;
  const int which = unlike ? 2 : program.recording();
  std::optional<Recorded> none;
  std::optional<Recorded>& last = unlike ? none : recorded[static_cast<std::size_t>(which)];
  const bool known = timing == KernelTiming::none && last == wanted;
  if (!known) {
    if (bound != Bound{program.id(), wanted.images, program.bindings()}) AFTERGLOW_CHECK(bind(program));
    bound = {program.id(), wanted.images, program.bindings()};
    wanted.bindings = program.bindings();
  }

  const auto start = Clock::now();
  auto done = known ? submitter.submit_again(which) : submitter.submit([&](VkCommandBuffer commands) {
    before(program, commands);
    program.record(commands, -1, queries, run);
    if (!separate) after(commands);
  }, which);
  if (done) done = submitter.wait();
  // Layouts are where they were when the frame ends as it began.
  std::vector<VkImageLayout> layouts;
  for (const auto& [name, image] : inputs) layouts.push_back(image.layout);
  last.reset();
  if (done && timing == KernelTiming::none && layouts == wanted.layouts) last = std::move(wanted);
  if (!done) return KernelTimer::blame(std::move(done).error(), program.plan());
  times.execute = milliseconds_since(start);
  if (stamps) {
    AFTERGLOW_TRY(times.kernels, timer.read(program.plan()));
  }
  if (!separate) return {};

  // Each kernel once more, alone: the same pixels again, since no input has changed.
  times.separate_submissions = true;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    if (!run[i]) continue;
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
  AFTERGLOW_CHECK(s.upload_changed(program, inputs, choose != nullptr, out));
  times.upload = milliseconds_since(start);

  Program* chosen = &program;
  if (choose) {
    AFTERGLOW_TRY(chosen, choose(*s.held.at("source").brightest));
  }
  if (!chosen) {
    copy_source(inputs.at("source"), out.pixels);
    return times;
  }
  if (chosen != &program) AFTERGLOW_CHECK(s.take_result(result_desc_of(*chosen), chosen->result_rows()));
  const std::vector<bool> run = s.kernels_to_run(*chosen);
  times.kernels_run = static_cast<int>(std::ranges::count(run, true));
  times.kernels_kept = static_cast<int>(run.size()) - times.kernels_run;
  if (times.kernels_run > 0) {
    s.result.writer = 0;
    s.ran_with.erase(chosen->id());  // until it has run
    AFTERGLOW_CHECK(s.execute(*chosen, run, timing, times));
    s.has_run(*chosen);
  }

  start = Clock::now();
  const Rect& part = chosen->parts().images[chosen->graph().result];
  AFTERGLOW_TRY(const std::uint64_t held, s.download(part, out));
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
  return {.images = state_->images,
          .buffers = state_->staging.buffers() + state_->timer.pools(),
          .recordings = state_->submitter.recordings()};
}

}  // namespace afterglow
