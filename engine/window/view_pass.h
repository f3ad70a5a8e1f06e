// SPDX-License-Identifier: MIT
// Draws source and result as a View says, into any colour target: each pixel once, by a shader made for the way in
// which one looks.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry.h"
#include "gpu/device.h"
#include "image/display_table.h"
#include "play/view.h"

namespace afterglow {

/// An image that fragment shaders may read when the pass runs: usage SAMPLED, barriers are the caller's. RGBA floats,
/// scene-linear, associated alpha. With `pixels`, what wrote the image is done.
struct ViewImage {
  VkImageView view = VK_NULL_HANDLE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  Size size;
  const std::byte* pixels = nullptr;  ///< where the processor may read them, in RGBA; null: nowhere
  std::size_t row_pitch = 0;          ///< of those, in bytes
  bool half = false;                  ///< those are half floats
  friend bool operator==(const ViewImage&, const ViewImage&) = default;
};

/// What shows through where alpha is below 1. none: alpha is ignored, RGB as it is.
enum class ViewBackground { none, gray, checker };

/// sRGB-encoded, 0…1.
using ViewColor = std::array<float, 3>;
/// Marks of false colour; where several apply to a pixel, the first of them counts.
inline constexpr ViewColor kMarkNotFinite{1.0f, 0.0f, 1.0f}, kMarkBelow{0.15f, 0.4f, 1.0f},
    kMarkAbove{1.0f, 0.35f, 0.1f};

/// Zones of Marks::stops: each is a stop of luminance, from half a stop below its own to half a stop above; the first
/// and the last go on. Zone 0 lies about middle grey, 0.18.
inline constexpr int kFirstZone = -6, kLastZone = 6;
inline constexpr std::array<ViewColor, kLastZone - kFirstZone + 1> kZones{{{0.06f, 0.06f, 0.09f},
                                                                           {0.25f, 0.10f, 0.35f},
                                                                           {0.38f, 0.20f, 0.68f},
                                                                           {0.16f, 0.33f, 0.80f},
                                                                           {0.10f, 0.52f, 0.76f},
                                                                           {0.10f, 0.58f, 0.50f},
                                                                           {0.50f, 0.50f, 0.50f},
                                                                           {0.35f, 0.68f, 0.25f},
                                                                           {0.74f, 0.80f, 0.22f},
                                                                           {0.96f, 0.76f, 0.16f},
                                                                           {0.95f, 0.50f, 0.14f},
                                                                           {0.90f, 0.20f, 0.16f},
                                                                           {1.00f, 1.00f, 1.00f}}};

struct ViewFrame {
  ViewImage shown;
  /// Left of (above) the wipe, or what the difference is taken from, when the view compares so. Flips and what lies
  /// side by side are `shown`.
  std::optional<ViewImage> compared;
  /// What coordinates of the view count in. Images of other sizes (an image between passes) are stretched over it.
  Size picture;
  View view;
  Rect area;  ///< of the target: what is drawn, and the window that the view speaks of
  ViewBackground background = ViewBackground::none;
  ViewColor outside{0.1f, 0.1f, 0.1f};  ///< beside the picture
  float pixel_scale = 1;                ///< of lines and squares (HiDPI)
  std::uint64_t content = 0;  ///< another number when the images may have other pixels than in the frame before
  friend bool operator==(const ViewFrame&, const ViewFrame&) = default;
};

/// The pixels of the target that the picture has; the others of its area are `outside`.
Rect picture_pixels(const ViewFrame& frame);

/// What is done to each pixel, in this order:
/// 1. Place (play/view.h). Magnified, the nearest pixel, exactly, or (View::smooth) bilinear in linear light; minified,
/// the mean in linear light over what a screen
///    pixel covers, by area. NaN counts as 0, infinities as ±1e30.
/// 2. A difference: by how much the two are apart, in red, green and blue; alpha is 1.
/// 3. Exposure, c·2^EV, then gamma, sign(c)·|c|^(1/gamma); not on alpha.
/// 4. Channel: one of them or luminance (Rec.709 weights) as grey; colour over the background.
/// 5. Marks. range: pixels are marked of which anything under the screen pixel is not finite, below 0 or above 1 (after
///    exposure, by more than 1e-4), in what the channel view looks at; others are grey. stops: the zone of what the
///    channel view looks at (of a colour its luminance) behind the exposure, without gamma; what is not finite is
///    marked.
/// 6. Clamped to 0…1 and sRGB-encoded, once: here, or by the target's format. With a table of a display, and while the
///    view wants it (View::as_display): codes that it has for light. Marks, differences, alpha, and what is beside the
///    picture stay sRGB.
/// Drawing thread alone.
class ViewPass {
 public:
  /// `target`: format of the colour target. `slots`: as many frames may be under way. Errors: device.
  static Result<std::unique_ptr<ViewPass>> create(const Device& device, VkFormat target, std::size_t slots);
  ~ViewPass();

  /// The display that is shown on; read until the next one. What was recorded before must be done. Errors: device.
  Result<void> take_table(const DisplayTable& table);
  /// Outside of rendering, before `record` with the same frames: brings a new table to the device. With a `target`
  /// (null: none) that can be copied to, which is and stays in COLOR_ATTACHMENT_OPTIMAL, devices on the CPU get what is
  /// nearest pixels or means as sRGB codes there and then from the processor, which takes a fifth of the shader's time.
  /// True when the target has such pixels now; `record` leaves them alone. Errors: device.
  Result<bool> prepare(VkCommandBuffer commands, std::size_t slot, VkImage target, std::span<const ViewFrame> frames,
                       std::span<const Rect> only);

  /// Pictures that one call records at most: two lie side by side.
  static constexpr std::size_t kMostFrames = 2;
  /// Within vkCmdBeginRendering on one colour target: of the frames' areas, what lies within `only` (which have no
  /// pixel in common). What was recorded with `slot` before must be done. Makes a pipeline when a way of looking
  /// (channel, marks, background, how pixels are read) comes first. Errors: device.
  Result<void> record(VkCommandBuffer commands, std::size_t slot, std::span<const ViewFrame> frames,
                      std::span<const Rect> only, const ViewColor& background);

 private:
  struct State;
  explicit ViewPass(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
