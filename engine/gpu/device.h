// SPDX-License-Identifier: MIT
// A Vulkan device: picked by name, or adopted from the caller. Owns nothing global.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "gpu/functions.h"

namespace afterglow {

struct DeviceInfo {
  std::string name, type, driver, uuid;  ///< type: "cpu", "integrated", "discrete", "virtual", "other"
  std::uint32_t api_version = 0;
  bool usable = false;
  std::string why_not;  ///< what it lacks, when not usable
  /// It can draw to and sample images of one and two channels of floats; most can, and Vulkan asks it of none.
  bool few_channels = false;
};

/// Devices in the order in which `--device auto` prefers them: discrete, integrated, virtual, cpu. Errors: device (no
/// loader, no driver).
Result<std::vector<DeviceInfo>> list_devices();

/// What showing pictures in a window takes. The gpu room knows no window system.
struct Presentation {
  std::vector<std::string> instance_extensions;  ///< as the window system names them: VK_KHR_surface and its own
  /// A new surface of the window; whoever calls it destroys the surface before the instance. Called when the device is
  /// chosen, by each Swapchain, and again when its surface is lost, on the calling thread. Errors: device.
  std::function<Result<VkSurfaceKHR>(VkInstance)> make_surface;
};

/// Ways of other devices that a device is made to take, so that they can be tested without such a device. Pictures stay
/// what they are, within the error that the way has anywhere.
struct ForcedWays {
  bool staging = false;     ///< pixels go over staging buffers
  bool unmapped = false;    ///< and images are neither mapped nor linear, as with memory that the host does not see
  bool timestamps = false;  ///< kernels are timed by timestamps, though they mean little around deferred draws
  std::string
      execution;  ///< words that go above the calibrated ones (shader/execution_config.h); checked by the caller
};

struct DeviceOptions {
  std::string device =
      "auto";             ///< "auto", an index into list_devices(), or a part of a name or uuid (case-insensitive)
  bool validate = false;  ///< Khronos validation with synchronization checks; errors when the layer is missing
  /// To show pictures in a window: the device is chosen among those that can present to it. Null: no window.
  std::shared_ptr<const Presentation> presentation{};
  ForcedWays forced{};
};

/// A caller's objects to work on; they must outlive the Device. The instance and device are of Vulkan 1.3, or
/// of 1.1 and 1.2 with VK_KHR_dynamic_rendering and VK_KHR_synchronization2; dynamicRendering and synchronization2 are
/// enabled.
struct AdoptedDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  /// Where all of Vulkan's functions come from; null: the system's loader.
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
};

/// What the validation layer has said. Thread-safe; may outlive its Device, so that messages of the teardown are seen
/// too.
class ValidationLog {
 public:
  /// `error`: of severity error and about validation. Warnings (performance advice among them) are kept, not counted.
  void add(bool error, const std::string& message);
  int errors() const;
  std::vector<std::string> messages() const;  ///< "error: …", "warning: …"; each text once, the first 1000

 private:
  mutable std::mutex mutex_;
  int errors_ = 0;
  std::vector<std::string> messages_;
};

/// One logical device with one graphics+compute queue. Immutable after creation. Whoever submits, presents or waits for
/// the queue holds `lock_queue` meanwhile; on an adopted device the host must not do so at the same time.
class Device {
 public:
  /// With "auto", a device that cannot be opened is passed over with a warning. `diagnostics` is used during the call
  /// alone. Errors: device (none, none that matches, none usable, none that can present, no validation layer).
  static Result<std::unique_ptr<Device>> create(const DeviceOptions& options, Diagnostics& diagnostics);
  /// Destroys none of the caller's objects. Errors: device (too old, a queue family without graphics).
  static Result<std::unique_ptr<Device>> adopt(const AdoptedDevice& adopted, Diagnostics& diagnostics);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const { return instance_; }
  VkDevice handle() const { return device_; }
  const VulkanFunctions& vk() const { return functions_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkQueue queue() const { return queue_; }
  std::unique_lock<std::mutex> lock_queue() const { return std::unique_lock(queue_mutex_); }
  /// After pipelines have been destroyed. lavapipe frees those that have run with a later submission: without one, a
  /// host that runs many looks once each would keep them all. An adopted device's queue is left to the caller.
  void free_destroyed() const;
  std::uint32_t queue_family() const { return queue_family_; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
  const VkPhysicalDeviceProperties& properties() const { return properties_; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
  const DeviceInfo& info() const { return info_; }
  VkDeviceSize max_allocation() const { return max_allocation_; }  ///< bytes of one VkDeviceMemory
  /// Null for a device without a window.
  const Presentation* presentation() const { return presentation_.get(); }
  bool is_cpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  const ForcedWays& forced() const { return forced_; }
  /// Fragment shaders may write buffers: on devices that were opened here and can.
  bool stores_from_fragments() const { return stores_from_fragments_; }
  /// Storage images may have formats of one and two channels beside R32F: on devices that were opened here and can.
  bool stores_few_channels() const { return stores_few_channels_; }
  /// Pixels are best written into images themselves, and read from there.
  bool maps_images() const { return is_cpu() && !forced_.staging && !forced_.unmapped; }
  /// Timestamps around draws mean something (false on CPU devices, where rasterisation is deferred), or have to serve.
  bool timestamps_mean_draws() const { return (!is_cpu() || forced_.timestamps) && timestamp_mask_ != 0; }
  /// The bits of a timestamp that count; 0: the queue has none.
  std::uint64_t timestamp_mask() const { return timestamp_mask_; }

  /// Names an object for debuggers and validation messages; nothing without validation.
  void set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const;
  void begin_label(VkCommandBuffer commands, const std::string& name) const;
  void end_label(VkCommandBuffer commands) const;

  /// Messages of severity error from the validation layer so far (0 without validation).
  int validation_errors() const;
  std::vector<std::string> validation_messages() const;
  /// Never null; still valid when the Device is gone.
  std::shared_ptr<const ValidationLog> validation_log() const { return log_; }

  /// Loads and saves the pipeline cache below `folder` (keyed by the device's pipeline cache UUID); unreadable data is
  /// ignored. Thread-safe, but for the first call with a folder: no pipeline may be made meanwhile.
  void use_pipeline_cache(const std::string& folder);
  void save_pipeline_cache() const;

 private:
  Device() = default;
  Result<void> finish();
  VulkanFunctions functions_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  mutable std::mutex queue_mutex_;
  std::uint32_t queue_family_ = 0;
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  VkDeviceSize max_allocation_ = 0;
  DeviceInfo info_;
  std::uint64_t timestamp_mask_ = 0;
  bool owned_ = false;
  bool stores_from_fragments_ = false;
  bool stores_few_channels_ = false;
  ForcedWays forced_;
  mutable std::mutex cache_mutex_;  ///< for the two below
  std::string cache_file_;
  mutable std::size_t cached_bytes_ = 0;  ///< of the pipeline cache, as its file has it
  std::shared_ptr<ValidationLog> log_;
  std::shared_ptr<const Presentation> presentation_;
};

}  // namespace afterglow
