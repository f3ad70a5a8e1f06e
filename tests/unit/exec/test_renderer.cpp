// SPDX-License-Identifier: MIT
// Frames in flight: what comes out is what comes out one at a time, in the same order, whatever overlaps.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <mutex>
#include <thread>

#include "exec/calibration.h"
#include "exec/renderer.h"
#include "workshop.h"

namespace afterglow {
namespace {

constexpr Size kSize{61, 37};

class RendererTest : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("test/gain", "uniform float gain;\nvec4 apply(vec4 color) { return vec4(color.rgb * gain, color.a); }\n");
    shader("test/offset", "uniform float by;\nvec4 apply(vec4 color) { return vec4(color.rgb + by, color.a); }\n");
    shared_ = std::make_shared<SharedKernels>(std::filesystem::path());
  }
  std::unique_ptr<ProgramCache> cache(const ProgramCacheOptions& options = {}) {
    return std::make_unique<ProgramCache>(device(), shared_, options);
  }
  static std::unique_ptr<Renderer> renderer(int frames, bool direct = false) {
    auto made = Renderer::create(device(), {.direct = direct, .frames = frames});
    EXPECT_TRUE(made) << made.error().text();
    return std::move(*made);
  }
  /// `offset`: another structure than without.
  static Graph graph(double gain, bool offset = false) {
    GraphBuilder builder(kSize);
    ImageId image = builder.pixel("gain", "test/gain", builder.source(), {}, {{"gain", number(gain)}});
    if (offset) image = builder.pixel("offset", "test/offset", image, {}, {{"by", number(1)}});
    return builder.finish(image);
  }
  RenderRequest request(ProgramCache& programs, const Graph& graph, const std::vector<float>& pixels) {
    RenderRequest out{.programs = &programs, .shaders = library_.get()};
    out.work = {.graph = graph, .texts = texts_of(graph, *library_).value()};
    out.inputs["source"] = {pixels.data(), kSize, 4};
    return out;
  }
  std::shared_ptr<SharedKernels> shared_;
};

/// The pixels, the values and now and then the structure are others in every frame; what one reads or writes too early
/// or too late is a wrong number.
TEST_F(RendererTest, FramesInFlightAreThoseOfOneAtATime) {
  constexpr int kFrames = 24;
  std::vector<std::vector<float>> sources;
  for (int i = 0; i < kFrames; ++i) sources.push_back(noise(kSize, static_cast<unsigned>(i)));
  for (const int frames : {1, 2, 3}) {
    const auto programs = cache();
    const auto ring = renderer(frames);
    ASSERT_EQ(ring->frames(), frames);
    int collected = 0;
    const auto collect = [&] {
      HostResult out;
      const auto report = ring->collect(out);
      ASSERT_TRUE(report) << report.error().text();
      const auto& source = sources[static_cast<std::size_t>(collected)];
      const float offset = collected % 7 == 3 ? 1 : 0;
      ASSERT_EQ(out.pixels.size(), source.size());
      for (std::size_t i = 0; i < source.size(); ++i) {
        const float want = i % 4 == 3 ? source[i] : source[i] * static_cast<float>(collected + 1) + offset;
        ASSERT_FLOAT_EQ(out.pixels[i], want) << "frame " << collected << " of " << frames << " in flight";
      }
      ++collected;
    };
    for (int i = 0; i < kFrames; ++i) {
      if (ring->in_flight() == frames) collect();
      const auto submitted =
          ring->submit(request(*programs, graph(i + 1, i % 7 == 3), sources[static_cast<std::size_t>(i)]));
      ASSERT_TRUE(submitted) << submitted.error().text();
    }
    EXPECT_EQ(ring->in_flight(), frames);
    while (ring->in_flight() > 0) collect();
    EXPECT_EQ(collected, kFrames);
  }
}

/// A device with timeline semaphores, on which a queue may wait for the host.
class TimedDevice {
 public:
  explicit TimedDevice(const Device& like) : vk_(like.vk()) {
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = like.queue_family(),
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan13Features newest{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                            .synchronization2 = VK_TRUE,
                                            .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceTimelineSemaphoreFeatures timeline{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES,
        .pNext = &newest,
        .timelineSemaphore = VK_TRUE};
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &timeline,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue};
    EXPECT_EQ(vk_.vkCreateDevice(like.physical(), &info, nullptr, &handle_), VK_SUCCESS);
    VkQueue made = VK_NULL_HANDLE;
    function<PFN_vkGetDeviceQueue>("vkGetDeviceQueue")(handle_, like.queue_family(), 0, &made);
    Diagnostics quiet;
    device_ = Device::adopt({like.instance(), like.physical(), handle_, made, like.queue_family()}, quiet).value();
  }
  ~TimedDevice() {
    device_.reset();
    function<PFN_vkDestroyDevice>("vkDestroyDevice")(handle_, nullptr);
  }
  TimedDevice(const TimedDevice&) = delete;
  TimedDevice& operator=(const TimedDevice&) = delete;

  Device& device() const { return *device_; }
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(vk_.vkGetDeviceProcAddr(handle_, name));
  }

 private:
  const VulkanFunctions& vk_;
  VkDevice handle_ = VK_NULL_HANDLE;
  std::unique_ptr<Device> device_;
};

/// Holds what is submitted behind it back until it is opened.
class Gate {
 public:
  explicit Gate(const TimedDevice& timed) : timed_(timed), handle_(timed.device().handle()) {
    const VkSemaphoreTypeCreateInfo type{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                         .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    const auto create = timed_.function<PFN_vkCreateSemaphore>("vkCreateSemaphore");
    EXPECT_EQ(create(handle_, &info, nullptr, &opened_), VK_SUCCESS);
  }
  ~Gate() {
    open();
    const auto lock = timed_.device().lock_queue();
    timed_.function<PFN_vkQueueWaitIdle>("vkQueueWaitIdle")(timed_.device().queue());
    timed_.function<PFN_vkDestroySemaphore>("vkDestroySemaphore")(handle_, opened_, nullptr);
  }
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;

  void close() {
    const std::uint64_t value = 1;
    const VkTimelineSemaphoreSubmitInfo values{.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                               .waitSemaphoreValueCount = 1,
                                               .pWaitSemaphoreValues = &value};
    const VkPipelineStageFlags everything = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                            .pNext = &values,
                            .waitSemaphoreCount = 1,
                            .pWaitSemaphores = &opened_,
                            .pWaitDstStageMask = &everything};
    const auto lock = timed_.device().lock_queue();
    const auto submit = timed_.function<PFN_vkQueueSubmit>("vkQueueSubmit");
    EXPECT_EQ(submit(timed_.device().queue(), 1, &wait, VK_NULL_HANDLE), VK_SUCCESS);
  }
  void open() {
    const std::lock_guard lock(mutex_);
    const VkSemaphoreSignalInfo signal{
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, .semaphore = opened_, .value = 1};
    if (!std::exchange(open_, true)) timed_.function<PFN_vkSignalSemaphore>("vkSignalSemaphore")(handle_, &signal);
  }

 private:
  const TimedDevice& timed_;
  VkDevice handle_;
  VkSemaphore opened_ = VK_NULL_HANDLE;
  std::mutex mutex_;
  bool open_ = false;
};

/// While frame 1 is on the device and cannot be done, frame 0 is read back and frame 2 is packed. Nothing here takes
/// time: what waits for frame 1 waits for good, until a watch opens the gate and the order of events is wrong.
TEST_F(RendererTest, ReadBackExecutionAndUploadOverlap) {
  std::vector<std::string> order;
  std::mutex mutex;
  const auto note = [&](const char* what) {
    const std::lock_guard lock(mutex);
    order.emplace_back(what);
  };
  const TimedDevice timed(device());
  const auto programs = std::make_unique<ProgramCache>(
      timed.device(), std::make_shared<SharedKernels>(std::filesystem::path()), ProgramCacheOptions{});
  const auto ring = Renderer::create(timed.device(), {.direct = false, .frames = 3}).value();
  const auto pixels = noise(kSize, 1);
  // Everything that is made once is made, so that frames 0 to 2 wait for nothing else.
  for (int i = 0; i < 6; ++i) {
    if (ring->in_flight() == 3) {
      HostResult out;
      ASSERT_TRUE(ring->collect(out));
    }
    ASSERT_TRUE(ring->submit(request(*programs, graph(1), pixels)));
  }
  HostResult out;
  while (ring->in_flight() > 0) ASSERT_TRUE(ring->collect(out));

  Gate gate(timed);
  std::promise<void> finished;
  std::thread watch([&, done = finished.get_future()] {
    if (done.wait_for(std::chrono::seconds(60)) == std::future_status::ready) return;
    note("waited for frame 1");
    gate.open();
  });
  EXPECT_TRUE(ring->submit(request(*programs, graph(2), pixels)));
  gate.close();
  EXPECT_TRUE(ring->submit(request(*programs, graph(3), pixels)));
  note("frame 1 is on its way");
  EXPECT_TRUE(ring->collect(out));
  note("frame 0 is read back");
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
  RenderRequest last = request(*programs, graph(4), pixels);
  std::once_flag packing;
  last.inputs["source"].read_row = [&](int y, float* row) {
    std::call_once(packing, [&] {
      note("frame 2 is packed");
      gate.open();
    });
    std::copy_n(pixels.data() + static_cast<std::ptrdiff_t>(y) * kSize.width * 4, kSize.width * 4, row);
  };
  EXPECT_TRUE(ring->submit(std::move(last)));
  finished.set_value();
  watch.join();
  for (const float gain : {3.f, 4.f}) {
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], gain * pixels[0]);
  }
  EXPECT_EQ(order, (std::vector<std::string>{"frame 1 is on its way", "frame 0 is read back", "frame 2 is packed"}));
}

TEST_F(RendererTest, ADeviceIsMadeToStage) {
  Diagnostics nowhere;
  for (const auto& [words, frames] : {std::pair("", device().is_cpu() ? 1 : 3), {"staging", 3}, {"unmapped", 3}}) {
    const auto own = Device::create({.forced = parse_forced(words).value()}, nowhere);
    ASSERT_TRUE(own) << own.error().text();
    const auto made = Renderer::create(**own, {.direct = true, .frames = 3});
    ASSERT_TRUE(made) << made.error().text();
    EXPECT_EQ((*made)->frames(), frames) << words;
  }
}

TEST_F(RendererTest, SteadyFramesMakeNothingNew) {
  const auto programs = cache();
  const auto ring = renderer(2);
  const auto pixels = noise(kSize, 1);
  HostResult out;
  Renderer::Counters steady;
  for (int i = 0; i < 10; ++i) {
    if (ring->in_flight() == 2) {
      ASSERT_TRUE(ring->collect(out));
    }
    if (i == 4) steady = ring->counters();
    ASSERT_TRUE(ring->submit(request(*programs, graph(i + 1), pixels)));
  }
  EXPECT_EQ(ring->counters().images, steady.images);
  EXPECT_EQ(ring->counters().buffers, steady.buffers);
  EXPECT_EQ(programs->programs(), 1);
}

/// A look at the surroundings, two kernels of which the first keeps its image; what an earlier frame handed on.
Graph surroundings(double gain) {
  GraphBuilder builder(kSize);
  const ImageId half = builder.sample("half", "test/half", {(kSize.width + 1) / 2, (kSize.height + 1) / 2},
                                      {{"image", builder.source()}}, {{"gain", number(gain)}});
  return builder.finish(builder.sample("sum", "test/sum", kSize, {{"image", builder.source()}, {"small", half}},
                                       {{"gain", number(gain)}}));
}

/// Drawn before the first frame or between frames, over images that are kept or not, in one's own memory or over
/// staging: the frames are as without.
TEST_F(RendererTest, WarmingUpChangesNoFrame) {
  shader("test/half",
         "uniform sampler2D image;\nuniform float gain;\n"
         "vec4 sample_at(ivec2 pixel) { return fetch(image, 2 * pixel) * gain; }\n");
  shader("test/sum",
         "uniform sampler2D image;\nuniform sampler2D small;\nuniform float gain;\n"
         "vec4 sample_at(ivec2 pixel) { return fetch(image, pixel) + gain * fetch(small, pixel / 2); }\n");
  const std::vector<float> pictures[] = {noise(kSize, 1), noise(kSize, 2)};
  for (const bool keep : {false, true})
    for (const int frames : {0, 1, 2}) {  // 0: direct
      const auto warmed = cache({.keep_images = keep});
      const auto own = std::make_shared<SharedKernels>(std::filesystem::path());  // and images
      const auto plain = std::make_unique<ProgramCache>(device(), own, ProgramCacheOptions{.keep_images = keep});
      const auto ours = renderer(std::max(frames, 1), frames == 0), theirs = renderer(1);
      for (int i = 0; i < 6; ++i) {
        // Two and two frames are alike; what is drawn between them has other settings.
        const auto which = static_cast<std::size_t>(i / 2 % 2);
        RenderRequest one = request(*warmed, surroundings(i / 2), pictures[which]);
        RenderRequest other = request(*plain, surroundings(i / 2), pictures[which]);
        one.inputs["source"].content = other.inputs["source"].content = Hash{1, which};
        if (i != 2) {
          ASSERT_TRUE(warmed->prepare(request(*warmed, surroundings(7), pictures[which]).work, *library_));
          const auto program = ours->warm_up(*warmed, *library_);
          ASSERT_TRUE(program) << program.error().text();
          EXPECT_EQ(*program, device().is_cpu() ? warmed->program() : nullptr);
        }
        HostResult got, wanted;
        const auto ran = ours->render(std::move(one), got);
        ASSERT_TRUE(ran) << ran.error().text();
        ASSERT_TRUE(theirs->render(std::move(other), wanted));
        EXPECT_EQ(got.pixels, wanted.pixels) << "frame " << i << ", kept: " << keep << ", " << frames;
      }
    }
}

/// The program for opaque pictures is there before the first of them is.
TEST_F(RendererTest, OpaquePicturesAreWarmedUpFor) {
  const auto programs = cache();
  const auto ring = renderer(1, true);
  Graph straight = graph(2);
  straight.passes.front().straight = true;
  std::vector<float> pixels = noise(kSize, 1);
  for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 1;
  RenderRequest one = request(*programs, straight, pixels);
  ASSERT_TRUE(programs->prepare(one.work, *library_));
  EXPECT_EQ(programs->programs(), 1);
  const auto usual = ring->warm_up(*programs, *library_);
  ASSERT_TRUE(usual) << usual.error().text();
  if (!device().is_cpu()) return;
  ASSERT_NE(*usual, nullptr);
  EXPECT_NE(*usual, programs->program());
  EXPECT_EQ(programs->programs(), 2);
  HostResult out;
  const auto ran = ring->render(std::move(one), out);
  ASSERT_TRUE(ran) << ran.error().text();
  EXPECT_EQ(ran->program, (*usual)->id());
  EXPECT_EQ(programs->programs(), 2);
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
}

/// The same picture and values again and again: no frame is the result of another slot's.
TEST_F(RendererTest, ASlotsOldResultIsNotTakenForTheNewOne) {
  const auto programs = cache({.keep_images = true});
  const auto ring = renderer(2);
  const auto pixels = noise(kSize, 1);
  HostResult out;
  int shown = 0;
  const auto collect = [&](float gain) {
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], pixels[0] * gain) << shown;
    ++shown;
  };
  const float gains[] = {2, 3, 3, 3, 2, 2, 3};
  for (int i = 0; i < 7; ++i) {
    if (ring->in_flight() == 2) collect(gains[shown]);
    RenderRequest one = request(*programs, graph(gains[i]), pixels);
    one.inputs["source"].content = Hash{1, 1};
    ASSERT_TRUE(ring->submit(std::move(one)));
  }
  while (ring->in_flight() > 0) collect(gains[shown]);
}

TEST_F(RendererTest, WhatRunsNothingIsItsSourceAndKeepsItsPlace) {
  const auto programs = cache();
  const auto ring = renderer(2);
  const auto first = noise(kSize, 1), second = noise(kSize, 2);
  GraphBuilder nothing(kSize);
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), first)));
  ASSERT_TRUE(ring->submit(request(*programs, nothing.finish(nothing.source()), second)));
  HostResult out;
  const auto ran = ring->collect(out);
  ASSERT_TRUE(ran);
  EXPECT_NE(ran->program, 0u);
  EXPECT_EQ(ran->kernels, std::vector<std::string>{"gain"});
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * first[0]);
  const auto left = ring->collect(out);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->program, 0u);
  EXPECT_EQ(out.pixels, second);
}

TEST_F(RendererTest, TooManyAndTooFewAreTold) {
  const auto programs = cache();
  const auto ring = renderer(1);
  const auto pixels = noise(kSize, 1);
  HostResult out;
  EXPECT_EQ(ring->collect(out).error().message, "no frame is in flight");
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), pixels)));
  const auto second = ring->submit(request(*programs, graph(2), pixels));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, "the frame before has to be collected first");
  EXPECT_TRUE(ring->collect(out)) << "the first one is as it was";
}

/// A frame that fails leaves the ones before it and those after it alone.
TEST_F(RendererTest, AFrameThatFailsIsNotInFlight) {
  const auto programs = cache();
  const auto ring = renderer(2);
  const auto pixels = noise(kSize, 1);
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), pixels)));
  RenderRequest wrong = request(*programs, graph(3), pixels);
  wrong.inputs["source"].size = {3, 3};
  EXPECT_FALSE(ring->submit(std::move(wrong)));
  ASSERT_TRUE(ring->submit(request(*programs, graph(5), pixels)));
  HostResult out;
  ASSERT_TRUE(ring->collect(out));
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
  ASSERT_TRUE(ring->collect(out));
  EXPECT_FLOAT_EQ(out.pixels[0], 5 * pixels[0]);
}

class ProgramCacheTest : public RendererTest {};

TEST_F(ProgramCacheTest, ProgramsAreFoundByAllThatMakesThemAndByNothingElse) {
  const auto programs = cache({.spare = 3});
  const auto work = [&](double gain, bool offset) {
    FrameWork out{.graph = graph(gain, offset)};
    out.texts = texts_of(out.graph, *library_).value();
    return out;
  };
  ASSERT_TRUE(programs->prepare(work(1, false), *library_));
  const std::uint64_t plain = programs->program()->id();
  EXPECT_TRUE(programs->has(work(9, false))) << "values make no new program";
  EXPECT_FALSE(programs->has(work(1, true))) << "passes do";
  FrameWork part = work(1, false);
  part.region = Rect{0, 0, 5, 5};
  EXPECT_FALSE(programs->has(part));
  FrameWork texts = work(1, false);
  texts.texts = Hash{1, 2};
  EXPECT_FALSE(programs->has(texts));
  FrameWork codes = work(1, false);
  codes.unorm8 = true;
  EXPECT_FALSE(programs->has(codes));
  ASSERT_TRUE(programs->prepare(work(1, true), *library_));
  const std::uint64_t other = programs->program()->id();
  EXPECT_NE(other, plain);
  ASSERT_TRUE(programs->prepare(work(4, false), *library_));
  EXPECT_EQ(programs->program()->id(), plain) << "it was spare";
  EXPECT_EQ(programs->program(plain), programs->program());
  EXPECT_EQ(programs->program(other), nullptr) << "of another structure";
  const auto none = cache();
  ASSERT_TRUE(none->prepare(work(1, false), *library_));
  ASSERT_TRUE(none->prepare(work(1, true), *library_));
  EXPECT_FALSE(none->has(work(1, false))) << "nothing is spare";
}

TEST_F(ProgramCacheTest, WhatCannotBeMadeLeavesNoPresentProgram) {
  const auto programs = cache();
  FrameWork good{.graph = graph(1)};
  good.texts = texts_of(good.graph, *library_).value();
  ASSERT_TRUE(programs->prepare(good, *library_));
  FrameWork bad = good;
  bad.region = Rect{0, 0, 1000, 1000};
  EXPECT_FALSE(programs->prepare(bad, *library_));
  EXPECT_EQ(programs->program(), nullptr);
  EXPECT_EQ(programs->work(), nullptr);
  EXPECT_TRUE(programs->prepare(good, *library_));
  EXPECT_NE(programs->program(), nullptr);
}

}  // namespace
}  // namespace afterglow
