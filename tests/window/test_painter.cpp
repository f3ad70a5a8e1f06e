// SPDX-License-Identifier: MIT
// Window, swapchain and interface on a display of their own, without a player.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "exec/submit.h"
#include "window/desktop_window.h"
#include "window/interface.h"
#include "window/painter.h"
#include "xvfb.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class PainterTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(xvfb_.runs()) << "Xvfb does not run";
    setenv("DISPLAY", xvfb_.display().c_str(), 1);
    folder_ = fs::temp_directory_path() / ("afterglow_painter" + std::to_string(getpid()));
    fs::create_directories(folder_);
    auto window = DesktopWindow::create("painter", {640, 400});
    ASSERT_TRUE(window) << window.error().text();
    window_ = std::move(*window);
    presentation_ = std::make_shared<Presentation>(*window_->presentation());
    presentation_->make_surface = [this, make = presentation_->make_surface](VkInstance instance) {
      ++surfaces_;
      return make(instance);
    };
    Diagnostics diagnostics;
    auto device = Device::create({.validate = true, .presentation = presentation_}, diagnostics);
    ASSERT_TRUE(device) << device.error().text();
    device_ = std::move(*device);
    interface_ = std::make_unique<Interface>(window_->handle());
    auto painter = Painter::create(*device_, {.readback = true}, true);
    ASSERT_TRUE(painter) << painter.error().text();
    painter_ = std::move(*painter);
    window_->show();
    make_picture();
  }

  void TearDown() override {
    painter_.reset();
    picture_ = GpuImage();
    interface_.reset();
    std::shared_ptr<const ValidationLog> log;
    if (device_) log = device_->validation_log();
    device_.reset();
    window_.reset();
    if (log) {
      EXPECT_EQ(log->errors(), 0) << log->messages().front();
    }
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  /// Linear 0.214 everywhere: sRGB code 127.
  void make_picture() {
    auto image = GpuImage::create(
        *device_,
        {.name = "picture", .size = {64, 40}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .tiling = VK_IMAGE_TILING_LINEAR},
        HostAccess::write);
    ASSERT_TRUE(image) << image.error().text();
    picture_ = std::move(*image);
    for (int y = 0; y < 40; ++y) {
      auto* row = reinterpret_cast<float*>(picture_.row(y));
      for (int i = 0; i < 64 * 4; ++i) row[i] = i % 4 == 3 ? 1.0f : 0.214f;
    }
    EXPECT_TRUE(picture_.memory().flush());
    auto submitter = Submitter::create(*device_);
    ASSERT_TRUE(submitter->submit([this](VkCommandBuffer commands) {
      const auto barrier = image_barrier(picture_.get(), VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT,
                                         VK_IMAGE_LAYOUT_PREINITIALIZED, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                         VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
      record_barriers(*device_, commands, &barrier, 1);
    }));
    ASSERT_TRUE(submitter->wait());
  }

  /// The picture in the left half, and a white square of the interface at its upper left corner.
  Swapchain::Drawn paint() {
    window_->wait(0);
    const auto [extent, size] = window_->extent();
    interface_->begin(extent, size);
    ImGui::GetForegroundDrawList()->AddRectFilled({10, 10}, {square_, 30}, IM_COL32(255, 255, 255, 255));
    const ImDrawData& data = interface_->end();
    ViewFrame frame;
    frame.shown = {picture_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, {64, 40}};
    frame.picture = {64, 40};
    frame.area = {0, 0, size.width / 2, size.height};
    frame.view.fit = false;
    frame.view.zoom = 128;
    frame.view.center = {32, 20};
    frame.content = content_;
    auto drawn = painter_->paint(size, {&frame, 1}, data);
    EXPECT_TRUE(drawn) << drawn.error().text();
    return drawn ? *drawn : Swapchain::Drawn::later;
  }

  Screen shot() { return screenshot(xvfb_.display(), (folder_ / "screen.ppm").string()); }

  /// Paints until the screen is as wanted: the server takes events when it likes.
  bool paint_until(const std::function<bool(const Screen&)>& wanted) {
    for (int i = 0; i < 200; ++i) {
      paint();
      if (const Screen screen = shot(); !screen.rgb.empty() && wanted(screen)) return true;
    }
    return false;
  }

  Xvfb xvfb_;
  fs::path folder_;
  int surfaces_ = 0;
  float square_ = 30;  ///< its right edge
  std::uint64_t content_ = 0;
  std::unique_ptr<DesktopWindow> window_;
  std::shared_ptr<Presentation> presentation_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Interface> interface_;
  std::unique_ptr<Painter> painter_;
  GpuImage picture_;
};

bool near(const std::uint8_t* rgb, int level) {
  return std::abs(rgb[0] - level) <= 1 && std::abs(rgb[1] - level) <= 1 && std::abs(rgb[2] - level) <= 1;
}

TEST_F(PainterTest, ShowsPictureAndInterface) {
  EXPECT_TRUE(paint_until([](const Screen& s) { return near(s.at(200, 200), 127); }));
  const Screen screen = shot();
  int x = 0, y = 0;
  glfwGetWindowPos(window_->handle(), &x, &y);
  EXPECT_TRUE(near(screen.at(x + 20, y + 20), 255));   // the square
  EXPECT_TRUE(near(screen.at(x + 50, y + 20), 127));   // the picture, encoded once
  EXPECT_TRUE(near(screen.at(x + 500, y + 200), 26));  // beside it
}

TEST_F(PainterTest, SteadyFramesMakeNothing) {
  for (int i = 0; i < 5; ++i) paint();
  const auto before = painter_->swapchain().counters();
  for (int i = 0; i < 50; ++i) {
    painter_->expose();
    EXPECT_EQ(paint(), Swapchain::Drawn::yes);
  }
  const auto after = painter_->swapchain().counters();
  EXPECT_EQ(after.presented, before.presented + 50);
  EXPECT_EQ(after.made, before.made);
  EXPECT_EQ(after.retired, 0u);
}

/// The screen keeps what was presented: the same again is not presented again, what differs in anything is.
TEST_F(PainterTest, WhatLooksAsBeforeIsNotPresented) {
  for (int i = 0; i < 5; ++i) paint();
  const auto presented = [&] { return painter_->swapchain().counters().presented; };
  const auto before = presented();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(paint(), Swapchain::Drawn::yes);
  EXPECT_EQ(presented(), before);
  painter_->expose();  // another window lay over it
  paint();
  paint();
  EXPECT_EQ(presented(), before + 1);
  ++content_;
  paint();
  paint();
  EXPECT_EQ(presented(), before + 2) << "another picture";
  square_ = 31;
  paint();
  paint();
  EXPECT_EQ(presented(), before + 3) << "a pixel of the interface";
  painter_->capture(folder_ / "again.png");
  EXPECT_EQ(paint(), Swapchain::Drawn::yes);
  EXPECT_TRUE(fs::exists(folder_ / "again.png")) << "a screenshot of what stands";
  EXPECT_EQ(presented(), before + 4);
}

TEST_F(PainterTest, FollowsItsWindowAndReleasesOldSwapchains) {
  paint();
  const Size sizes[] = {{700, 500}, {500, 350}, {900, 600}, {640, 480}, {480, 320}, {800, 640}, {1000, 700}};
  for (const Size size : sizes) {
    glfwSetWindowSize(window_->handle(), size.width, size.height);
    EXPECT_TRUE(paint_until([&](const Screen& s) {
      return near(s.at(size.width / 2 - 5, size.height - 5), 127) &&
             near(s.at(size.width / 2 + 5, size.height - 5), 26);
    })) << size.width
        << "×" << size.height;
  }
  for (int i = 0; i < 10; ++i) {
    painter_->expose();
    paint();
  }
  EXPECT_GE(painter_->swapchain().counters().made, std::size(sizes));
  EXPECT_EQ(painter_->swapchain().counters().retired, 0u);
}

TEST_F(PainterTest, NothingIsDrawnWithoutArea) {
  paint();
  const auto before = painter_->swapchain().counters();
  interface_->begin(window_->extent().window, window_->extent().framebuffer);
  const ImDrawData& data = interface_->end();
  const auto drawn = painter_->paint({0, 0}, {}, data);
  ASSERT_TRUE(drawn) << drawn.error().text();
  EXPECT_EQ(*drawn, Swapchain::Drawn::minimised);
  EXPECT_EQ(painter_->swapchain().counters().presented, before.presented);
  EXPECT_EQ(paint(), Swapchain::Drawn::yes);
}

TEST_F(PainterTest, FontsOfAnotherScaleTakeEffect) {
  paint();
  EXPECT_FALSE(interface_->set_scale(1));
  EXPECT_TRUE(interface_->set_scale(2));
  ASSERT_TRUE(painter_->take_fonts());
  EXPECT_EQ(paint(), Swapchain::Drawn::yes);
  EXPECT_FLOAT_EQ(interface_->ui().body->FontSize, 30);
}

TEST_F(PainterTest, WritesWhatTheWindowShows) {
  const fs::path file = folder_ / "window.png";
  painter_->capture(file);
  while (paint() != Swapchain::Drawn::yes) {
  }
  std::string out;
  ASSERT_EQ(run_on(xvfb_.display(), "convert " + file.string() + " -crop 1x1+50+20 txt:-", &out), 0);
  EXPECT_NE(out.find("#7F7F7F"), std::string::npos) << out;
  ASSERT_EQ(run_on(xvfb_.display(), "identify -format '%wx%h' " + file.string(), &out), 0);
  EXPECT_EQ(out, "640x400");
}

/// The painter holds each frame that draws only what has changed against one that is drawn wholly: `paint` fails where
/// a pixel differs.
class PainterPartsTest : public PainterTest {
 protected:
  /// What an interface may do from frame to frame.
  struct State {
    bool panel = false, overlay = false, message = false, moved = false;
    float slider = 0.2f;
    int frame = 0;  ///< a text that changes
    double zoom = 128;
    double exposure = 0;
    std::uint64_t content = 0;
    std::optional<Compare> compare;
    CompareBy by = CompareBy::wipe;
    double wipe = 0.5;
  };

  void draw_interface(const State& s) {
    constexpr auto kFlags = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing;
    if (s.panel) {
      ImGui::SetNextWindowPos({400, 0});
      ImGui::SetNextWindowSize({240, 400});
      ImGui::Begin("panel", nullptr, kFlags);
      float value = s.slider;
      ImGui::SliderFloat("slider", &value, 0, 1);
      for (int i = 0; i < 12; ++i) ImGui::Text("row %d of many", i);
      ImGui::Text("frame %d", s.frame);
      ImGui::End();
    }
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    if (s.overlay) {
      list.AddRectFilled({20, 100}, {220, 180}, IM_COL32(10, 12, 14, 200), 5);
      list.AddText({30, 110}, IM_COL32_WHITE, ("shown " + std::to_string(s.frame)).c_str());
      list.AddCircle({180, 140}, 25.3f, IM_COL32(250, 160, 60, 150), 0, 1.7f);
      list.AddLine({22.5f, 170}, {215, 105.2f}, IM_COL32(250, 160, 60, 220), 1.3f);
    }
    if (s.message) list.AddText({60.5f, 350.25f}, IM_COL32(255, 200, 90, 230), "a message over the picture");
    const float x = s.moved ? 333.3f : 250;
    list.AddRectFilledMultiColor({x, 20}, {x + 60, 60}, IM_COL32_WHITE, IM_COL32_BLACK, IM_COL32(255, 0, 0, 90),
                                 IM_COL32(0, 0, 255, 128));
  }

  void show(const State& s, std::span<const Rect> written = {}) {
    window_->wait(0);
    const auto [extent, size] = window_->extent();
    interface_->begin(extent, size);
    draw_interface(s);
    const ImDrawData& data = interface_->end();
    ViewFrame frame;
    frame.shown = {picture_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, {64, 40}};
    if (s.compare) frame.compared = frame.shown;
    frame.picture = {64, 40};
    frame.area = {0, 0, s.panel ? 400 : size.width, size.height - 50};
    frame.view.fit = false;
    frame.view.zoom = s.zoom;
    frame.view.center = {32, 20};
    frame.view.exposure = s.exposure;
    frame.view.compare = s.compare.value_or(Compare::none);
    frame.view.by = s.by;
    frame.view.wipe = s.wipe;
    frame.content = s.content;
    const auto drawn = painter_->paint(size, {&frame, 1}, data, written);
    EXPECT_TRUE(drawn) << drawn.error().text();
  }
  /// In every image of the window, with what was there before in some of them.
  void show_often(const State& s) {
    for (int i = 0; i < 6; ++i) {
      painter_->expose();  // drawn, though the screen has it already
      show(s);
    }
  }

  /// Other light in the upper half of the picture; whoever calls has waited for its readers.
  void write_picture(float light) {
    ASSERT_TRUE(painter_->finish());
    for (int y = 0; y < 20; ++y) {
      auto* row = reinterpret_cast<float*>(picture_.row(y));
      for (int i = 0; i < 64 * 4; ++i) row[i] = i % 4 == 3 ? 1.0f : light * static_cast<float>(i % 7) / 7;
    }
    EXPECT_TRUE(picture_.memory().flush());
  }
};

TEST_F(PainterPartsTest, ShowWhatWholeFramesShow) {
  State s;
  show_often(s);
  s.panel = true;
  show_often(s);
  for (int i = 0; i < 8; ++i) {
    s.slider += 0.05f;
    ++s.frame;
    show(s);
  }
  s.overlay = true;
  show_often(s);
  for (int i = 0; i < 8; ++i) {
    ++s.frame;
    ++s.content;
    write_picture(0.1f * static_cast<float>(i));
    show(s);
  }
  s.message = true;
  show(s);
  s.message = false;
  show_often(s);
  s.moved = true;
  show(s);
  s.exposure = 1;
  show(s);
  s.zoom = 3.7;
  show_often(s);
  s.compare = Compare::source;
  for (const double at : {0.2, 0.4, 0.41, 0.9}) {
    s.wipe = at;
    show(s);
  }
  s.by = CompareBy::difference;
  show(s);
  s.compare.reset();
  s.panel = false;
  show_often(s);
}

TEST_F(PainterPartsTest, FollowTheWindowTheFontsAndTheAtlas) {
  State s{.panel = true, .overlay = true};
  show_often(s);
  for (const Size size : {Size{701, 433}, Size{640, 400}, Size{903, 611}}) {
    glfwSetWindowSize(window_->handle(), size.width, size.height);
    for (int i = 0; i < 100 && window_->extent().framebuffer != size; ++i) window_->wait(0.1);
    EXPECT_EQ(window_->extent().framebuffer, size);
    ++s.frame;
    show_often(s);
  }
  EXPECT_TRUE(interface_->set_scale(2));
  ASSERT_TRUE(painter_->take_fonts());
  show_often(s);
  // All glyphs are gone: what was drawn with them looks different, though its triangles are the same.
  unsigned char* pixels = nullptr;
  Rect atlas;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &atlas.width, &atlas.height);
  std::memset(pixels, 0x60, static_cast<std::size_t>(atlas.size().area()) * 4);
  show(s, {&atlas, 1});
  show_often(s);
}

TEST_F(PainterPartsTest, ADisplayIsTakenOverAll) {
  State s{.panel = true, .content = 3};
  show_often(s);
  DisplayTable table{.name = "gray", .planes = 2, .size = {2 * kDisplayTiles, 2}};
  table.codes.assign(static_cast<std::size_t>(table.size.area()) * 4, 0.25f);
  ASSERT_TRUE(painter_->take_display(table));
  show_often(s);
}

TEST_F(PainterTest, DroppedFilesArrive) {
  GLFWdropfun drop = glfwSetDropCallback(window_->handle(), nullptr);
  ASSERT_NE(drop, nullptr);
  const char* paths[] = {"/tmp/a.lua", "/tmp/b.exr"};
  drop(window_->handle(), 2, paths);
  const WindowEvents events = window_->take_events();
  EXPECT_TRUE(events.any);
  EXPECT_EQ(events.dropped, (std::vector<fs::path>{"/tmp/a.lua", "/tmp/b.exr"}));
  EXPECT_FALSE(window_->take_events().any);
}

TEST(DesktopWindow, WithoutADisplayItSaysSo) {
  setenv("DISPLAY", ":65000", 1);
  unsetenv("WAYLAND_DISPLAY");
  const auto window = DesktopWindow::create("nowhere", {100, 100});
  ASSERT_FALSE(window);
  EXPECT_EQ(window.error().kind, ErrorKind::device);
  EXPECT_NE(window.error().text().find("--headless"), std::string::npos) << window.error().text();
}

}  // namespace
}  // namespace afterglow
