// SPDX-License-Identifier: MIT
// The view on lavapipe against the same mathematics in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "exec/submit.h"
#include "gpu/image.h"
#include "image/encode.h"
#include "view_oracle.h"
#include "window/view_pass.h"

namespace afterglow {
namespace {

constexpr VkFormat kTarget = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Smooth, with noise, a few values out of range and a few that are not finite.
Image picture(Size size, unsigned seed) {
  Image out(size.width, size.height, 4);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(0, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      float* c = out.at(x, y);
      c[0] = 0.9f * static_cast<float>(x) / static_cast<float>(size.width);
      c[1] = 0.9f * static_cast<float>(y) / static_cast<float>(size.height);
      c[2] = 0.7f * noise(random);
      c[3] = noise(random);
    }
  }
  out.at(3, 2)[0] = 5;
  out.at(7, 5)[1] = -0.25f;
  out.at(9, 9)[2] = std::numeric_limits<float>::quiet_NaN();
  out.at(12, 4)[0] = std::numeric_limits<float>::infinity();
  out.at(1, 11)[3] = -1;
  return out;
}

class ViewPassTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Diagnostics diagnostics;
    auto made = Device::create({.validate = true}, diagnostics);
    ASSERT_TRUE(made) << made.error().text();
    device_ = std::move(*made).release();
  }
  static void TearDownTestSuite() {
    const auto log = device_->validation_log();
    delete device_;
    EXPECT_EQ(log->errors(), 0) << (log->messages().empty() ? "" : log->messages().front());
  }

  static GpuImage upload(const Image& image, bool half = false) {
    auto made = GpuImage::create(*device_,
                                 {.name = "picture",
                                  .size = image.size(),
                                  .format = float_format(4, half),
                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                  .tiling = VK_IMAGE_TILING_LINEAR},
                                 HostAccess::write);
    EXPECT_TRUE(made) << made.error().text();
    for (int y = 0; y < image.height; ++y) {
      const auto values = static_cast<std::size_t>(image.width) * 4;
      if (half) {
        to_half(image.at(0, y), reinterpret_cast<std::uint16_t*>(made->row(y)), values);
      } else {
        std::memcpy(made->row(y), image.at(0, y), values * sizeof(float));
      }
    }
    made->memory().flush();
    return std::move(*made);
  }

  static Image draw(const ViewFrame& frame, Size target_size, const std::vector<VkImage>& sources,
                    VkFormat format = kTarget) {
    auto target =
        GpuImage::create(*device_, {.name = "target",
                                    .size = target_size,
                                    .format = format,
                                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    EXPECT_TRUE(target) << target.error().text();
    const auto bytes = static_cast<VkDeviceSize>(target_size.area()) * 16;
    auto buffer = Buffer::create(*device_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read, "pixels");
    auto pass = ViewPass::create(*device_, format, 1);
    EXPECT_TRUE(pass) << pass.error().text();
    if (display_) {
      EXPECT_TRUE((*pass)->take_table(*display_));
    }
    auto submitter = Submitter::create(*device_);
    EXPECT_TRUE(submitter->submit(
        [&](VkCommandBuffer commands) { record(commands, **pass, frame, target_size, *target, *buffer, sources); }));
    EXPECT_TRUE(submitter->wait());
    buffer->memory().invalidate();
    Image out(target_size.width, target_size.height, 4);
    std::memcpy(out.pixels.data(), buffer->data(), out.bytes());
    return out;
  }

  static void record(VkCommandBuffer commands, ViewPass& pass, const ViewFrame& frame, Size size,
                     const GpuImage& target, const Buffer& buffer, const std::vector<VkImage>& sources) {
    std::vector<VkImageMemoryBarrier2> before;
    for (VkImage source : sources) {
      before.push_back(image_barrier(source, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT,
                                     VK_IMAGE_LAYOUT_PREINITIALIZED, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
    }
    before.push_back(image_barrier(target.get(), VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED,
                                   VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
    record_barriers(*device_, commands, before.data(), before.size());
    // In two parts, which meet where no tile ends.
    const std::array<Rect, 2> all{
        {{0, 0, size.width / 3, size.height}, {size.width / 3, 0, size.width - size.width / 3, size.height}}};
    const auto copied = pass.prepare(commands, 0, copies_ ? target.get() : VK_NULL_HANDLE, {&frame, 1}, all);
    ASSERT_TRUE(copied) << copied.error().text();
    copied_ = *copied;
    const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = target.view(),
                                          .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                          .loadOp = copied_ ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .clearValue = {.color = {.float32 = {-1, -1, -1, -1}}}};
    const VkExtent2D extent{static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height)};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, extent},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color};
    device_->vk().vkCmdBeginRendering(commands, &rendering);
    EXPECT_TRUE(pass.record(commands, 0, {&frame, 1}, all, {-1, -1, -1}));
    device_->vk().vkCmdEndRendering(commands);
    const auto into = image_barrier(target.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    record_barriers(*device_, commands, &into, 1);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {extent.width, extent.height, 1}};
    device_->vk().vkCmdCopyImageToBuffer(commands, target.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.get(), 1,
                                         &copy);
    const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    device_->vk().vkCmdPipelineBarrier2(commands, &dependency);
  }

  /// Draws and compares each pixel of the area. How many pixels were neither the surroundings nor equal to all others.
  static void expect_same(ViewFrame frame, const Image& shown, const Image* compared, Size target, const char* what) {
    const GpuImage gpu_shown = upload(shown);
    const GpuImage gpu_compared = compared ? upload(*compared) : GpuImage();
    std::vector<VkImage> sources{gpu_shown.get()};
    frame.shown = {gpu_shown.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, shown.size()};
    if (compared) {
      frame.compared = ViewImage{gpu_compared.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, compared->size()};
      sources.push_back(gpu_compared.get());
    }
    const Image drawn = draw(frame, target, sources);
    const ViewOracle oracle(frame, shown, compared, display_);
    int wrong = 0, inside = 0;
    for (int y = 0; y < target.height; ++y) {
      for (int x = 0; x < target.width; ++x) {
        const float* got = drawn.at(x, y);
        const Rect& a = frame.area;
        if (x < a.x || y < a.y || x >= a.x + a.width || y >= a.y + a.height) {
          ASSERT_EQ(got[0], -1) << what << ": drawn outside of the area at " << x << ", " << y;
          continue;
        }
        const Rgb want = oracle.at(x, y);
        ++inside;
        for (int i = 0; i < 3; ++i) {
          if (std::abs(got[i] - want[i]) <= 2e-4) continue;
          if (++wrong <= 5) {
            ADD_FAILURE() << what << ": pixel " << x << ", " << y << " channel " << i << " is " << got[i] << ", not "
                          << want[i];
          }
        }
        ASSERT_EQ(got[3], 1);
      }
    }
    EXPECT_EQ(wrong, 0) << what;
    EXPECT_EQ(inside, frame.area.width * frame.area.height);
  }

  /// Pictures that the processor may read, on targets that it can copy to. `compared` may be null.
  static void expect_codes(ViewFrame frame, const Image& shown, const Image* compared, Size target, VkFormat format,
                           bool half, bool by_processor) {
    const GpuImage gpu_shown = upload(shown, half);
    const GpuImage gpu_compared = compared ? upload(*compared, half) : GpuImage();
    const auto view_of = [&](const GpuImage& image) {
      return ViewImage{.view = image.view(),
                       .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       .size = image.desc().size,
                       .pixels = image.row(0),
                       .row_pitch = image.row_pitch(),
                       .half = half};
    };
    std::vector<VkImage> sources{gpu_shown.get()};
    frame.shown = view_of(gpu_shown);
    if (compared) {
      frame.compared = view_of(gpu_compared);
      sources.push_back(gpu_compared.get());
    }
    copies_ = true;
    const Image drawn = draw(frame, target, sources, format);
    copies_ = false;
    EXPECT_EQ(copied_, by_processor);
    copied_ = false;
    const ViewOracle oracle(frame, shown, compared, display_);
    const auto* codes = reinterpret_cast<const std::uint8_t*>(drawn.pixels.data());
    const bool blue_first = format == VK_FORMAT_B8G8R8A8_UNORM;
    int wrong = 0;
    for (int y = 0; y < target.height; ++y)
      for (int x = 0; x < target.width; ++x, codes += 4) {
        const Rgb want = oracle.at(x, y);
        for (std::size_t i = 0; i < 3; ++i) {
          const int got = codes[blue_first ? 2 - i : i];
          if (std::abs(got - 255 * want[i]) <= 0.5 + (half ? 0.07 : 0.01)) continue;
          if (++wrong <= 5) ADD_FAILURE() << x << ", " << y << " channel " << i << ": " << got << ", " << 255 * want[i];
        }
        ASSERT_EQ(codes[3], 255);
      }
    EXPECT_EQ(wrong, 0);
  }

  static Device* device_;
  static const DisplayTable* display_;  ///< that the pass is given
  static inline bool copies_ = false;   ///< the pass may copy into the target
  static inline bool copied_ = false;   ///< and did
};
Device* ViewPassTest::device_ = nullptr;
const DisplayTable* ViewPassTest::display_ = nullptr;

const Size kPicture{23, 17};

ViewFrame frame_of(Rect area, View view) {
  ViewFrame frame;
  frame.picture = kPicture;
  frame.area = area;
  frame.view = view;
  return frame;
}

TEST_F(ViewPassTest, PlacesMagnifiesAndMinifies) {
  const Image image = picture(kPicture, 1);
  const Rect area{5, 3, 61, 47};
  expect_same(frame_of(area, {}), image, nullptr, {70, 55}, "fit");
  for (const double zoom : {0.125, 0.23, 0.5, 0.81, 1.0, 1.37, 2.0, 3.0, 7.7, 16.0}) {
    // Centres off the grid, so that no pixel's middle lies on the border of two of the picture's.
    const View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
    expect_same(frame_of(area, view), image, nullptr, {70, 55}, std::to_string(zoom).c_str());
  }
}

TEST_F(ViewPassTest, TheProcessorMakesTheSameCodes) {
  const Image image = picture(kPicture, 1), before = picture(kPicture, 5), small = picture({15, 13}, 6);
  for (const VkFormat format : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const bool half : {false, true})
      for (const double zoom : {0.125, 0.23, 0.5, 0.81, 1.0, 1.37, 3.0, 7.7, 16.0}) {
        SCOPED_TRACE(std::to_string(format) + (half ? ", halves, " : ", floats, ") + std::to_string(zoom));
        View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}, .exposure = half ? 0 : 1.5};
        expect_codes(frame_of({0, 0, 61, 47}, view), image, nullptr, {61, 47}, format, half, true);
        view.compare = Compare::source;
        view.wipe = 0.413;
        view.wipe_vertical = half;
        expect_codes(frame_of({0, 0, 61, 47}, view), small, &before, {61, 47}, format, half, true);
      }
}

TEST_F(ViewPassTest, TheProcessorLeavesOtherWaysToTheShader) {
  const Image image = picture(kPicture, 1), before = picture(kPicture, 5);
  const auto shader_draws = [&](const View& view, ViewBackground background = ViewBackground::none) {
    ViewFrame frame = frame_of({0, 0, 61, 47}, view);
    frame.background = background;
    expect_codes(frame, image, &before, {61, 47}, VK_FORMAT_B8G8R8A8_UNORM, false, false);
  };
  shader_draws({.smooth = true});
  shader_draws({.channel = ViewChannel::green});
  shader_draws({.marks = Marks::range});
  shader_draws({}, ViewBackground::checker);
  View view;
  view.gamma = 1.8;
  shader_draws(view);
  view = {};
  view.compare = Compare::other;
  view.by = CompareBy::difference;
  shader_draws(view);
}

TEST_F(ViewPassTest, MagnifiesSmoothly) {
  const Image image = picture(kPicture, 1);
  for (const double zoom : {0.5, 1.0, 1.37, 7.7, 16.0}) {
    const View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}, .smooth = true};
    expect_same(frame_of({5, 3, 61, 47}, view), image, nullptr, {70, 55}, std::to_string(zoom).c_str());
  }
}

TEST_F(ViewPassTest, AtOneToOneEveryPixelIsThePictures) {
  const Image image = picture(kPicture, 2);
  View view;
  one_to_one(view, kPicture, {23, 17});
  expect_same(frame_of({0, 0, 23, 17}, view), image, nullptr, {23, 17}, "1:1");
}

TEST_F(ViewPassTest, ChannelsExposureAndBackgrounds) {
  const Image image = picture(kPicture, 3);
  for (const auto channel : {ViewChannel::color, ViewChannel::red, ViewChannel::green, ViewChannel::blue,
                             ViewChannel::alpha, ViewChannel::luminance}) {
    for (const double exposure : {0.0, -2.5, 1.75}) {
      for (const Marks marks : {Marks::none, Marks::range, Marks::stops}) {
        for (const double zoom : {0.4, 2.0}) {
          View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
          view.exposure = exposure;
          view.channel = channel;
          view.marks = marks;
          view.gamma = zoom < 1 ? 1.8 : 0.6;
          expect_same(frame_of({0, 0, 48, 36}, view), image, nullptr, {48, 36},
                      (view_channel_name(channel) + ", marks: " + marks_name(marks)).c_str());
        }
      }
    }
  }
  for (const auto background : {ViewBackground::gray, ViewBackground::checker}) {
    ViewFrame frame = frame_of({0, 0, 48, 36}, {});
    frame.background = background;
    frame.pixel_scale = 1.5f;
    expect_same(frame, image, nullptr, {48, 36}, "background");
  }
}

TEST_F(ViewPassTest, FalseColorFindsOneBadPixelAtAnyZoom) {
  Image image(64, 64, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
  image.at(37, 21)[1] = std::numeric_limits<float>::quiet_NaN();
  View view{.fit = false, .zoom = 1.0 / 32, .center = {32, 32}, .marks = Marks::range};
  ViewFrame frame = frame_of({0, 0, 2, 2}, view);
  frame.picture = {64, 64};
  const GpuImage gpu = upload(image);
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, {2, 2}, {gpu.get()});
  EXPECT_NEAR(drawn.at(1, 0)[0], kMarkNotFinite[0], 1e-3);
  EXPECT_NEAR(drawn.at(1, 0)[1], kMarkNotFinite[1], 1e-3);
  EXPECT_NEAR(drawn.at(0, 0)[0], drawn.at(0, 0)[1], 1e-6);  // grey: nothing is marked here
  EXPECT_GT(drawn.at(0, 0)[0], 0.5f);
}

/// A quarter of a stop above and below each zone's own: both are of its colour.
TEST_F(ViewPassTest, EveryStopHasItsZone) {
  const int zones = static_cast<int>(kZones.size());
  Image image(zones, 2, 4);
  for (int zone = 0; zone < zones; ++zone) {
    for (int y = 0; y < 2; ++y) {
      float* c = image.at(zone, y);
      std::fill(c, c + 3, 0.18f * std::exp2(static_cast<float>(kFirstZone + zone) + (y == 0 ? 0.25f : -0.25f)));
      c[3] = 1;
    }
  }
  View view;
  view.marks = Marks::stops;
  view.gamma = 2.2;  // zones are of the light
  one_to_one(view, image.size(), image.size());
  ViewFrame frame = frame_of({0, 0, zones, 2}, view);
  frame.picture = image.size();
  const GpuImage gpu = upload(image);
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, image.size(), {gpu.get()});
  for (int zone = 0; zone < zones; ++zone)
    for (int y = 0; y < 2; ++y)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(drawn.at(zone, y)[c], kZones[static_cast<std::size_t>(zone)][c], 1e-3) << kFirstZone + zone;
}

TEST_F(ViewPassTest, WipesBetweenImagesOfAnySize) {
  const Image after = picture(kPicture, 4), before = picture(kPicture, 5), small = picture({15, 13}, 6);
  for (const bool vertical : {false, true}) {
    for (const double zoom : {0.6, 3.0}) {
      View view{.fit = false, .zoom = zoom, .center = {11.213, 8.347}};
      view.compare = Compare::source;
      view.wipe = 0.413;
      view.wipe_vertical = vertical;
      expect_same(frame_of({4, 2, 48, 36}, view), after, &before, {56, 40}, "same size");
      expect_same(frame_of({4, 2, 48, 36}, view), small, &before, {56, 40}, "smaller result");
      expect_same(frame_of({4, 2, 48, 36}, view), after, nullptr, {56, 40}, "nothing to compare with");
    }
  }
}

TEST_F(ViewPassTest, ShowsHowFarTwoImagesAreApart) {
  const Image after = picture(kPicture, 4), before = picture(kPicture, 5);
  for (const ViewChannel channel : {ViewChannel::color, ViewChannel::green, ViewChannel::luminance}) {
    View view{.fit = false, .zoom = 3, .center = {11.213, 8.347}, .exposure = 1.5, .channel = channel};
    view.compare = Compare::other;
    view.by = CompareBy::difference;
    expect_same(frame_of({4, 2, 48, 36}, view), after, &before, {56, 40}, "difference");
  }
}

/// A small table with a shaper of its own, whose codes lie beyond 0…1 too: what is read in it shows at once.
DisplayTable odd_table() {
  DisplayTable out{.name = "odd", .planes = 11, .zero = 3, .bend = 2, .cells = 3, .cells_below = 4};
  out.size = {out.planes * kDisplayTiles, out.planes * 2};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(-0.2f, 1.2f);
  for (long long i = 0; i < out.size.area() * 4; ++i) out.codes.push_back(noise(random));
  return out;
}

TEST_F(ViewPassTest, LightIsShownAsTheDisplayHasIt) {
  const DisplayTable table = odd_table();
  Image image = picture({40, 30}, 7), other = picture({40, 30}, 8);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> wide(-0.6f, 4);
  for (std::size_t i = 0; i < 600; ++i) image.pixels[i * 4 + i % 3] = wide(random);
  for (float* equal : {image.at(5, 5), image.at(6, 5)}) equal[0] = equal[1] = equal[2] = 0.3f;
  display_ = &table;
  for (const auto channel : {ViewChannel::color, ViewChannel::green, ViewChannel::alpha, ViewChannel::luminance})
    for (const Marks marks : {Marks::none, Marks::range, Marks::stops})
      for (const bool as_display : {true, false}) {
        View view;
        one_to_one(view, image.size(), image.size());
        view.channel = channel;
        view.marks = marks;
        view.exposure = 0.5;
        view.as_display = as_display;
        ViewFrame frame = frame_of({0, 0, 40, 30}, view);
        frame.picture = image.size();
        expect_same(frame, image, nullptr, {40, 30}, (view_channel_name(channel) + ", " + marks_name(marks)).c_str());
      }
  View view;
  view.compare = Compare::other;
  for (const CompareBy by : {CompareBy::wipe, CompareBy::difference}) {
    view.by = by;
    ViewFrame frame = frame_of({2, 1, 40, 30}, view);
    frame.picture = image.size();
    expect_same(frame, image, &other, {44, 33}, compare_by_name(by).c_str());
  }
  display_ = nullptr;
}

/// Of the table's codes, targets that encode make the same codes again.
TEST_F(ViewPassTest, TargetsThatEncodeShowTheDisplaysCodes) {
  const DisplayTable table = odd_table();
  Image image(1, 1, 4);
  for (float& v : image.pixels) v = 0.214f;
  const GpuImage gpu = upload(image);
  ViewFrame frame = frame_of({0, 0, 2, 2}, {});
  frame.picture = {1, 1};
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  display_ = &table;
  const Image drawn = draw(frame, {2, 2}, {gpu.get()}, VK_FORMAT_R8G8B8A8_SRGB);
  display_ = nullptr;
  std::array<std::uint8_t, 4> texel{};
  std::memcpy(texel.data(), drawn.pixels.data(), texel.size());
  const auto wanted = read_display_table(table, {0.214, 0.214, 0.214});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(texel[c], 255 * wanted[c], 1);
}

TEST_F(ViewPassTest, TargetsThatEncodeAreNotEncodedTwice) {
  Image image(1, 1, 4);
  for (float& v : image.pixels) v = 0.214f;
  const GpuImage gpu = upload(image);
  ViewFrame frame = frame_of({0, 0, 2, 2}, {});
  frame.picture = {1, 1};
  frame.shown = {gpu.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, image.size()};
  const Image drawn = draw(frame, {2, 2}, {gpu.get()}, VK_FORMAT_R8G8B8A8_SRGB);
  std::uint32_t texel = 0;
  std::memcpy(&texel, drawn.pixels.data(), sizeof texel);
  EXPECT_NEAR(static_cast<int>(texel & 0xff), 127, 1);  // sRGB code of 0.214
}

}  // namespace
}  // namespace afterglow
