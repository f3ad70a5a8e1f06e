// SPDX-License-Identifier: MIT
#include "window/painter.h"

#include <imgui.h>

#include <array>
#include <utility>

#include "image/writer.h"

namespace afterglow {

namespace {

/// At which bytes of a pixel red, green and blue lie; none: no 8-bit codes.
std::optional<std::array<std::size_t, 3>> code_order(VkFormat format) {
  switch (format) {
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
      return std::array<std::size_t, 3>{2, 1, 0};
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_UNORM_PACK32:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
      return std::array<std::size_t, 3>{0, 1, 2};
    default:
      return std::nullopt;
  }
}

}  // namespace

Result<std::unique_ptr<Painter>> Painter::create(Device& device, const SwapchainOptions& options, bool check) {
  std::unique_ptr<Painter> out(new Painter(device));
  AFTERGLOW_TRY(out->swapchain_, Swapchain::create(device, options));
  const VkFormat format = out->swapchain_->format();
  if (check && code_order(format)) out->check_ = std::make_unique<PaintCheck>();
  const std::size_t slots = Swapchain::kFramesInFlight * (out->check_ ? 2 : 1);
  AFTERGLOW_TRY(out->view_pass_, ViewPass::create(device, format, slots));
  AFTERGLOW_TRY(out->ui_, UiRenderer::create(device, format, slots));
  AFTERGLOW_CHECK(out->ui_->take_fonts());
  return out;
}

Result<void> Painter::take_fonts() {
  AFTERGLOW_CHECK(swapchain_->finish());
  ++glyphs_;
  return ui_->take_fonts();
}

Result<void> Painter::take_display(const DisplayTable& table) {
  AFTERGLOW_CHECK(swapchain_->finish());
  ++glyphs_;
  return view_pass_->take_table(table);
}

/// What the frame shows, in `tiles_`.
void Painter::look(Size size, std::span<const ViewFrame> views, const ImDrawData& interface,
                   std::span<const Rect> written) {
  looked_ = size;
  std::vector<ViewFrame> now(views.begin(), views.end());
  for (ViewFrame& frame : now) {
    frame.content = 0;
    // Pictures that follow each other may lie in turn in several images.
    frame.shown.view = VK_NULL_HANDLE;
    frame.shown.pixels = nullptr;
    if (frame.compared) {
      frame.compared->view = VK_NULL_HANDLE;
      frame.compared->pixels = nullptr;
    }
  }
  if (now != views_) {
    ++look_;
    views_ = std::move(now);
  }
  tiles_.begin(size, glyphs_);
  for (const ViewFrame& frame : views) {
    const auto handle = [](VkImageView view) { return reinterpret_cast<std::uint64_t>(view); };
    tiles_.add(frame.area, look_);
    std::uint64_t content = mixed(frame.content, handle(frame.shown.view));
    if (frame.compared) content = mixed(content, handle(frame.compared->view));
    tiles_.add(picture_pixels(frame), content);
  }
  ui_->look(interface, written, tiles_);
}

Result<void> Painter::record(VkCommandBuffer commands, const PresentTarget& target, std::span<const ViewFrame> views,
                             const ImDrawData& interface, std::span<const Rect> written) {
  if (looked_ != target.size) look(target.size, views, interface, written);
  if (shown_.size() <= target.index) shown_.resize(target.index + 1);
  std::vector<std::uint64_t>& shown = shown_[target.index];
  if (!target.kept || !keeps_) shown.clear();
  const std::vector<Rect> only = tiles_.changed(shown);
  shown.clear();  // until all of it is recorded
  AFTERGLOW_CHECK(ui_->prepare(commands, target.slot, interface, written, only));
  if (!only.empty()) AFTERGLOW_CHECK(record_parts(commands, target, views, interface, only));
  shown = tiles_.numbers();
  return {};
}

Result<void> Painter::record_parts(VkCommandBuffer commands, const PresentTarget& target,
                                   std::span<const ViewFrame> views, const ImDrawData& interface,
                                   std::span<const Rect> only) {
  const VkImage copied_to = target.takes_copies ? target.image : VK_NULL_HANDLE;
  AFTERGLOW_TRY(const bool copied, view_pass_->prepare(commands, target.slot, copied_to, views, only));
  const VkRenderingAttachmentInfo color{
      .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
      .imageView = target.view,
      .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
      .loadOp = target.kept || copied ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
      .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  const VkRenderingInfo rendering{
      .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
      .renderArea = {{0, 0},
                     {static_cast<std::uint32_t>(target.size.width), static_cast<std::uint32_t>(target.size.height)}},
      .layerCount = 1,
      .colorAttachmentCount = 1,
      .pColorAttachments = &color};
  device_.vk().vkCmdBeginRendering(commands, &rendering);
  const auto viewed = view_pass_->record(commands, target.slot, views, only, {0.1f, 0.1f, 0.1f});
  ui_->record(commands, target.slot, interface);
  device_.vk().vkCmdEndRendering(commands);
  return viewed;
}

/// The same frame, drawn wholly, beside the one that is shown.
Result<void> Painter::record_check(VkCommandBuffer commands, const PresentTarget& target,
                                   std::span<const ViewFrame> views, const ImDrawData& interface) {
  AFTERGLOW_TRY(PresentTarget whole, check_->begin(device_, commands, target));
  whole.slot += Swapchain::kFramesInFlight;
  const Rect all{0, 0, target.size.width, target.size.height};
  AFTERGLOW_CHECK(ui_->prepare(commands, whole.slot, interface, {}, {&all, 1}));
  AFTERGLOW_CHECK(record_parts(commands, whole, views, interface, {&all, 1}));
  return check_->end(device_, commands, target);
}

Result<Swapchain::Drawn> Painter::paint(Size window, std::span<const ViewFrame> views, const ImDrawData& interface,
                                        std::span<const Rect> written) {
  const bool capture = !capture_.empty();
  Result<void> recorded;
  Buffer pixels;
  Size size;
  bool checked = false;
  looked_ = {};
  if (const auto now = swapchain_->shown(window); now && !on_screen_.empty() && written.empty() && !capture) {
    look(*now, views, interface, written);
    if (tiles_.numbers() == on_screen_) return Swapchain::Drawn::yes;
  }
  on_screen_.clear();
  AFTERGLOW_TRY(const auto drawn, swapchain_->draw(window, [&](VkCommandBuffer commands, const PresentTarget& target) {
    recorded = record(commands, target, views, interface, written);
    checked = recorded && check_ && target.kept && keeps_ && swapchain_->readable();
    if (checked) recorded = record_check(commands, target, views, interface);
    if (!recorded || !capture || !swapchain_->readable() || !code_order(swapchain_->format())) return;
    auto buffer = Buffer::create(device_, static_cast<VkDeviceSize>(target.size.area()) * 4,
                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read, "capture");
    if (!buffer) {
      recorded = std::move(buffer).error();
      return;
    }
    pixels = std::move(*buffer);
    size = target.size;
    copy_target(device_, commands, target.image, target.size, pixels);
  }));
  AFTERGLOW_CHECK(std::move(recorded));
  if (checked) {
    AFTERGLOW_CHECK(swapchain_->finish());
    AFTERGLOW_CHECK(check_->compare());
  }
  if (drawn == Swapchain::Drawn::yes) on_screen_ = tiles_.numbers();
  if (capture && drawn == Swapchain::Drawn::yes) captured_ = write_capture(pixels, size);
  return drawn;
}

Result<std::filesystem::path> Painter::write_capture(const Buffer& pixels, Size size) {
  const std::filesystem::path file = std::exchange(capture_, {});
  if (size.area() == 0) return Error{ErrorKind::device, "the images of this window cannot be read", file.string()};
  AFTERGLOW_CHECK(swapchain_->finish());
  AFTERGLOW_CHECK(pixels.memory().invalidate());
  const auto order = *code_order(swapchain_->format());
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  picture.data_window = picture.display_window = {0, 0, size.width, size.height};
  picture.unorm8.resize(static_cast<std::size_t>(size.area()) * 4, 255);
  for (std::size_t i = 0; i < picture.unorm8.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) picture.unorm8[i + c] = static_cast<std::uint8_t>(pixels.data()[i + order[c]]);
  }
  Diagnostics nowhere;
  AFTERGLOW_CHECK(write_picture(picture, file, {.type = SampleType::uint8}, nowhere));
  return file;
}

}  // namespace afterglow
