// SPDX-License-Identifier: MIT
// EXRs of several layers and parts, each channel of one value.
#pragma once

#include <OpenImageIO/imageio.h>

#include <map>

#include "cli_test.h"

namespace afterglow::test {

/// A part: its name and eye (both may be empty), and the value of each channel.
struct LayerPart {
  std::map<std::string, float> channels;
  std::string name, view;
};

class LayersTest : public CliTest {
 protected:
  static std::map<std::string, float> colours(const std::string& layer, float value) {
    return {{layer + "R", value}, {layer + "G", value}, {layer + "B", value}};
  }
  static std::map<std::string, float> with(std::map<std::string, float> channels,
                                           const std::map<std::string, float>& more) {
    channels.insert(more.begin(), more.end());
    return channels;
  }

  void make_layers(const std::string& name, const std::vector<LayerPart>& parts, int width = 32,
                   int height = 24) const {
    std::vector<OIIO::ImageSpec> specs;
    std::vector<std::vector<float>> pixels;
    for (const LayerPart& part : parts) {
      OIIO::ImageSpec spec(width, height, static_cast<int>(part.channels.size()), OIIO::TypeDesc::FLOAT);
      spec.channelnames.clear();
      std::vector<float> pixel;
      for (const auto& [channel, value] : part.channels) {
        spec.channelnames.push_back(channel);
        pixel.push_back(value);
      }
      if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
      if (!part.view.empty()) spec.attribute("view", part.view);
      specs.push_back(spec);
      std::vector<float>& all = pixels.emplace_back();
      for (int i = 0; i < width * height; ++i) all.insert(all.end(), pixel.begin(), pixel.end());
    }
    fs::create_directories(path(name).parent_path());
    auto out = OIIO::ImageOutput::create(text(name));
    ASSERT_TRUE(out && out->open(text(name), static_cast<int>(specs.size()), specs.data())) << OIIO::geterror();
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (i > 0) {
        ASSERT_TRUE(out->open(text(name), specs[i], OIIO::ImageOutput::AppendSubimage)) << out->geterror();
      }
      ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, pixels[i].data())) << out->geterror();
    }
    ASSERT_TRUE(out->close());
  }

  /// What lies between 8 and 10 becomes twice as bright.
  void make_depth_look(const std::string& name, const std::string& more = "") const {
    write(name, "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { post_exposure = 1, " +
                    more + "mask = fx.mask.depth { from = 8, to = 10, softness = 0 } } }\n");
  }
};

}  // namespace afterglow::test
