// SPDX-License-Identifier: MIT
// What overlaps while frames are in flight: shown by the order of events, not by time.
#include <chrono>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "renderer_test.h"

namespace afterglow {
namespace {

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
/// time: what waits for frame 1 waits for good, until a watch opens the gate and says so.
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
  EXPECT_TRUE(ring->submit(request(*programs, graph(3), pixels)));  // and frame 0 goes to the device
  gate.close();
  RenderRequest last = request(*programs, graph(4), pixels);
  std::once_flag once;
  std::promise<void> packing;
  last.inputs["source"].read_row = [&](int y, float* row) {
    std::call_once(once, [&] { packing.set_value(); });
    std::copy_n(pixels.data() + static_cast<std::ptrdiff_t>(y) * kSize.width * 4, kSize.width * 4, row);
  };
  EXPECT_TRUE(ring->submit(std::move(last)));  // and frame 1
  EXPECT_TRUE(ring->collect(out));
  note("frame 0 is read back");
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
  packing.get_future().wait();
  note("frame 2 is packed");
  gate.open();
  finished.set_value();
  watch.join();
  for (const float gain : {3.f, 4.f}) {
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], gain * pixels[0]);
  }
  EXPECT_EQ(order, (std::vector<std::string>{"frame 0 is read back", "frame 2 is packed"}));
}

}  // namespace
}  // namespace afterglow
