// SPDX-License-Identifier: MIT
#include "gpu/swapchain.h"

#include <algorithm>
#include <limits>

#include "gpu/error.h"
#include "gpu/fence.h"
#include "gpu/image.h"

namespace afterglow {

namespace {

constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
/// Some window systems keep all images while a window is hidden: come back later instead of blocking for good.
constexpr std::uint64_t kAcquireNanoseconds = 100'000'000;
/// While a window is dragged each frame may need a new swapchain; beyond so many old ones, wait for the queue.
constexpr std::uint64_t kMostRetired = 4;

VkCompositeAlphaFlagBitsKHR choose_alpha(VkCompositeAlphaFlagsKHR supported) {
  for (const auto bit : {VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR, VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
                         VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR}) {
    if (supported & bit) return bit;
  }
  return VK_COMPOSITE_ALPHA_POST_MULTIPLIED_BIT_KHR;
}

Result<SemaphoreHandle> make_semaphore(const Device& device, const char* name) {
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore), "cannot create a semaphore");
  SemaphoreHandle out(device, semaphore);
  device.set_name(VK_OBJECT_TYPE_SEMAPHORE, out.number(), name);
  return out;
}

template <class T, class Query>
std::vector<T> all_of(const Query& query) {
  std::uint32_t count = 0;
  if (query(&count, nullptr) != VK_SUCCESS) return {};
  std::vector<T> out(count);
  if (query(&count, out.data()) < 0) return {};
  out.resize(count);
  return out;
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, const SwapchainOptions& options) {
  if (!device.presentation()) return Error{ErrorKind::device, "the device was opened without a window"};
  std::unique_ptr<Swapchain> out(new Swapchain(device));
  out->options_ = options;
  AFTERGLOW_CHECK(out->make_slots());
  AFTERGLOW_CHECK(out->make_surface());
  return out;
}

Swapchain::~Swapchain() {
  retire_chain();
  (void)drain();  // a lost device has nothing left to wait for
  retired_.clear();
}

Result<void> Swapchain::make_slots() {
  for (Slot& slot : slots_) {
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                            .queueFamilyIndex = device_.queue_family()};
    VkCommandPool pool = VK_NULL_HANDLE;
    AFTERGLOW_VK(device_.vk().vkCreateCommandPool(device_.handle(), &pool_info, nullptr, &pool),
                 "cannot create a command pool");
    slot.pool = CommandPoolHandle(device_, pool);
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    AFTERGLOW_VK(device_.vk().vkAllocateCommandBuffers(device_.handle(), &allocate, &slot.commands),
                 "cannot allocate a command buffer");
    const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence = VK_NULL_HANDLE;
    AFTERGLOW_VK(device_.vk().vkCreateFence(device_.handle(), &fence_info, nullptr, &fence), "cannot create a fence");
    slot.done = FenceHandle(device_, fence);
    AFTERGLOW_TRY(slot.acquired, make_semaphore(device_, "image acquired"));
  }
  return {};
}

Result<void> Swapchain::make_surface() {
  AFTERGLOW_TRY(surface_, Surface::create(device_.vk(), device_.instance(), *device_.presentation()));
  ++counters_.surfaces;
  VkBool32 presents = VK_FALSE;
  AFTERGLOW_VK(device_.vk().vkGetPhysicalDeviceSurfaceSupportKHR(device_.physical(), device_.queue_family(),
                                                                 surface_.get(), &presents),
               "cannot ask about the window");
  if (!presents) return Error{ErrorKind::device, "device '" + device_.info().name + "' cannot present to the window"};
  const auto formats = all_of<VkSurfaceFormatKHR>([&](std::uint32_t* count, VkSurfaceFormatKHR* out) {
    return device_.vk().vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_.get(), count, out);
  });
  const auto chosen = choose_surface_format(formats);
  if (!chosen) return Error{ErrorKind::device, "the window has no format of sRGB codes"};
  if (format_.format != VK_FORMAT_UNDEFINED && format_.format != chosen->format) {
    return Error{ErrorKind::device, "the window came back with another format"};
  }
  format_ = *chosen;
  return {};
}

/// False when the window has no area.
Result<bool> Swapchain::make_chain(Size window, bool surface_may_be_lost) {
  VkSurfaceCapabilitiesKHR surface{};
  VkResult asked = device_.vk().vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_.get(), &surface);
  if (asked == VK_ERROR_SURFACE_LOST_KHR) {
    AFTERGLOW_CHECK(lose_surface());
    asked = device_.vk().vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_.get(), &surface);
  }
  AFTERGLOW_VK(asked, "cannot ask about the window");
  const Size size = choose_extent(surface, window);
  if (size.area() == 0) return false;

  const auto modes = all_of<VkPresentModeKHR>([&](std::uint32_t* count, VkPresentModeKHR* out) {
    return device_.vk().vkGetPhysicalDeviceSurfacePresentModesKHR(device_.physical(), surface_.get(), count, out);
  });
  readable_ = options_.readback && (surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (readable_) usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  takes_copies_ = device_.is_cpu() && (surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  if (takes_copies_) usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkSwapchainCreateInfoKHR info{
      .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
      .surface = surface_.get(),
      .minImageCount = choose_image_count(surface),
      .imageFormat = format_.format,
      .imageColorSpace = format_.colorSpace,
      .imageExtent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height)},
      .imageArrayLayers = 1,
      .imageUsage = usage,
      .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
      .preTransform = (surface.supportedTransforms & VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR)
                          ? VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR  // the display turns it, where it is turned
                          : surface.currentTransform,
      .compositeAlpha = choose_alpha(surface.supportedCompositeAlpha),
      .presentMode = choose_present_mode(modes, options_.tearing),
      .clipped = VK_FALSE,  // images keep what was drawn into them, under other windows too
      .oldSwapchain = chain_ ? chain_->swapchain.get() : VK_NULL_HANDLE};
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  const VkResult created = device_.vk().vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &swapchain);
  retire_chain();  // by the call, whatever came of it
  if (created == VK_ERROR_SURFACE_LOST_KHR && surface_may_be_lost) {
    AFTERGLOW_CHECK(lose_surface());
    return make_chain(window, false);
  }
  AFTERGLOW_VK(created, "cannot create a swapchain");
  auto chain = std::make_shared<Chain>();
  chain->swapchain = SwapchainHandle(device_, swapchain);
  chain->size = size;
  AFTERGLOW_CHECK(fill_chain(*chain));
  chain_ = std::move(chain);
  ++chain_number_;
  ++counters_.made;
  made_for_ = window;
  stale_ = false;
  if (counters_.retired > kMostRetired) AFTERGLOW_CHECK(drain());
  return true;
}

Result<void> Swapchain::fill_chain(Chain& chain) {
  const auto images = all_of<VkImage>([&](std::uint32_t* count, VkImage* out) {
    return device_.vk().vkGetSwapchainImagesKHR(device_.handle(), chain.swapchain.get(), count, out);
  });
  if (images.empty()) return Error{ErrorKind::device, "the swapchain has no images"};
  for (VkImage image : images) {
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format_.format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkImageView view = VK_NULL_HANDLE;
    AFTERGLOW_VK(device_.vk().vkCreateImageView(device_.handle(), &info, nullptr, &view),
                 "cannot create an image view");
    Image& made = chain.images.emplace_back();
    made.image = image;
    made.view = ImageViewHandle(device_, view);
    AFTERGLOW_TRY(made.drawn, make_semaphore(device_, "frame drawn"));
    device_.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image), "window");
  }
  return {};
}

Result<Swapchain::Drawn> Swapchain::draw(Size window, const Draw& draw) {
  Slot& slot = slots_[next_slot_];
  AFTERGLOW_CHECK(wait(slot));
  release();
  if (window.width <= 0 || window.height <= 0) return Drawn::minimised;
  // Once more when the window changes under our hands; if it goes on changing, with the next frame.
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (!chain_ || stale_ || made_for_ != window) {
      AFTERGLOW_TRY(const bool made, make_chain(window));
      if (!made) return Drawn::minimised;
    }
    AFTERGLOW_TRY(const auto index, acquire(slot));
    if (!index) {
      if (stale_) continue;
      return Drawn::later;
    }
    Image& image = chain_->images[*index];
    if (image.presented) slot.proves_chain = chain_number_;
    AFTERGLOW_CHECK(submit(slot, image, *index, draw));
    next_slot_ = (next_slot_ + 1) % slots_.size();
    AFTERGLOW_CHECK(present(image, *index));
    return Drawn::yes;
  }
  return Drawn::later;
}

/// None when there is no image to draw to now; `stale_` when the swapchain must be made anew first.
Result<std::optional<std::uint32_t>> Swapchain::acquire(Slot& slot) {
  std::uint32_t index = 0;
  const VkResult result = device_.vk().vkAcquireNextImageKHR(
      device_.handle(), chain_->swapchain.get(), kAcquireNanoseconds, slot.acquired.get(), VK_NULL_HANDLE, &index);
  switch (result) {
    case VK_SUBOPTIMAL_KHR:  // its semaphore will be signalled: the image has to be drawn and presented
      note_suboptimal();
      return std::optional(index);
    case VK_SUCCESS:
      return std::optional(index);
    case VK_TIMEOUT:
    case VK_NOT_READY:
      return std::optional<std::uint32_t>();
    case VK_ERROR_SURFACE_LOST_KHR:
      AFTERGLOW_CHECK(lose_surface());
      return std::optional<std::uint32_t>();
    case VK_ERROR_OUT_OF_DATE_KHR:
      stale_ = true;
      return std::optional<std::uint32_t>();
    default:
      return vulkan_error(result, "cannot acquire an image of the window");
  }
}

Result<void> Swapchain::submit(Slot& slot, const Image& image, std::size_t index, const Draw& draw) {
  AFTERGLOW_VK(device_.vk().vkResetCommandPool(device_.handle(), slot.pool.get(), 0), "cannot reset commands");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  AFTERGLOW_VK(device_.vk().vkBeginCommandBuffer(slot.commands, &begin), "cannot record commands");
  // Behind the semaphore's wait, which is for the same stage.
  const auto into = image_barrier(image.image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                                  image.presented ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : VK_IMAGE_LAYOUT_UNDEFINED,
                                  VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  record_barriers(device_, slot.commands, &into, 1);
  draw(slot.commands, {image.image, image.view.get(), format_.format, chain_->size, next_slot_, index, image.presented,
                       takes_copies_});
  const auto out_of = image_barrier(image.image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
  record_barriers(device_, slot.commands, &out_of, 1);
  AFTERGLOW_VK(device_.vk().vkEndCommandBuffer(slot.commands), "cannot record commands");

  const VkFence fence = slot.done.get();
  AFTERGLOW_VK(device_.vk().vkResetFences(device_.handle(), 1, &fence), "cannot reset a fence");
  const VkSemaphoreSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                   .semaphore = slot.acquired.get(),
                                   .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
  const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = image.drawn.get(),
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = slot.commands};
  const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                           .waitSemaphoreInfoCount = 1,
                           .pWaitSemaphoreInfos = &wait,
                           .commandBufferInfoCount = 1,
                           .pCommandBufferInfos = &buffer,
                           .signalSemaphoreInfoCount = 1,
                           .pSignalSemaphoreInfos = &signal};
  {
    const auto lock = device_.lock_queue();
    AFTERGLOW_VK(device_.vk().vkQueueSubmit2(device_.queue(), 1, &info, fence), "cannot submit a frame");
  }
  slot.pending = true;
  slot.frame = ++frame_number_;
  return {};
}

Result<void> Swapchain::present(Image& image, std::uint32_t index) {
  const VkSemaphore drawn = image.drawn.get();
  const VkSwapchainKHR swapchain = chain_->swapchain.get();
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn,
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain,
                              .pImageIndices = &index};
  const VkResult result = [&] {
    const auto lock = device_.lock_queue();
    return device_.vk().vkQueuePresentKHR(device_.queue(), &info);
  }();
  image.presented = true;
  ++counters_.presented;
  switch (result) {
    case VK_SUBOPTIMAL_KHR:
      note_suboptimal();
      return {};
    case VK_SUCCESS:
      return {};
    case VK_ERROR_OUT_OF_DATE_KHR:
    case VK_ERROR_SURFACE_LOST_KHR:  // the next frame finds out when it asks about the window
      stale_ = true;
      return {};
    default:
      return vulkan_error(result, "cannot present a frame");
  }
}

/// Some surfaces stay suboptimal whatever one does (a screen that is turned): one try for each size.
void Swapchain::note_suboptimal() {
  if (suboptimal_at_ == chain_->size) return;
  suboptimal_at_ = chain_->size;
  stale_ = true;
}

Result<void> Swapchain::wait(Slot& slot) {
  if (!slot.pending) return {};
  const VkFence fence = slot.done.get();
  AFTERGLOW_VK(wait_for_fence(device_, fence), "the device did not finish a frame");
  slot.pending = false;
  frames_done_ = std::max(frames_done_, slot.frame);
  proven_chain_ = std::max(proven_chain_, slot.proves_chain);
  return {};
}

Result<void> Swapchain::finish() {
  Result<void> done;
  for (Slot& slot : slots_) {
    auto waited = wait(slot);
    if (done && !waited) done = std::move(waited);
  }
  release();
  return done;
}

void Swapchain::retire(std::shared_ptr<void> object) {
  if (object) retired_.push_back({std::move(object), frame_number_, 0});
}

void Swapchain::retire_chain() {
  if (!chain_) return;
  retired_.push_back({std::move(chain_), frame_number_, chain_number_});
  chain_ = nullptr;
  ++counters_.retired;
}

/// Waits for everything on the queue, presentations too as far as Vulkan 1.3 can, and destroys all that was retired.
Result<void> Swapchain::drain() {
  const VkResult idle = [&] {
    const auto lock = device_.lock_queue();
    return device_.vk().vkQueueWaitIdle(device_.queue());
  }();
  AFTERGLOW_CHECK(finish());  // of frames more is known than of the queue
  AFTERGLOW_VK(idle, "the device did not finish");
  proven_chain_ = chain_number_ + (chain_ ? 0 : 1);
  release();
  return {};
}

void Swapchain::release() {
  std::erase_if(retired_, [this](const Retired& old) {
    // An image of a later swapchain came back from the display: what was queued for display before is past.
    const bool over = old.frame <= frames_done_ && (old.chain == 0 || old.chain < proven_chain_);
    if (over && old.chain != 0) --counters_.retired;
    return over;
  });
}

Result<void> Swapchain::lose_surface() {
  retire_chain();
  AFTERGLOW_CHECK(drain());
  stale_ = true;
  surface_ = Surface();
  return make_surface();
}

std::optional<Size> Swapchain::shown(Size window) const {
  if (!chain_ || stale_ || made_for_ != window || counters_.presented == 0) return std::nullopt;
  return chain_->size;
}

Swapchain::Counters Swapchain::counters() const { return counters_; }

}  // namespace afterglow
