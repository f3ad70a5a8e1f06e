// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/layers.h"

namespace afterglow {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using Names = std::vector<std::string>;

FilePart part(Names channels, std::string name = "") {
  FilePart made;
  made.name = std::move(name);
  made.channels = std::move(channels);
  return made;
}

/// Chosen channels by name, "part/channel" when there are several parts; "-" for none.
Names chosen(const std::vector<FilePart>& parts, const ChannelChoice& choice) {
  Names names;
  for (const int c : choice.channels) {
    const FilePart& from = parts[static_cast<std::size_t>(choice.part)];
    names.push_back(c < 0 ? "-"
                          : (parts.size() > 1 ? from.name + "/" : "") + from.channels[static_cast<std::size_t>(c)]);
  }
  return names;
}
Names color(const std::vector<FilePart>& parts, const std::string& name = "") {
  return chosen(parts, find_color(parts, name).value());
}
Names depth(const std::vector<FilePart>& parts, const std::string& name = "") {
  const auto base = find_color(parts, "");
  const auto found = find_depth(parts, name, base ? &base.value() : nullptr);
  return found.value() ? chosen(parts, *found.value()) : Names{};
}
Names normal(const std::vector<FilePart>& parts, const std::string& name = "") {
  const auto base = find_color(parts, "");
  const auto found = find_normal(parts, name, base ? &base.value() : nullptr);
  return found.value() ? chosen(parts, *found.value()) : Names{};
}

const std::vector<FilePart> kBlender{
    part({"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
          "ViewLayer.Depth.Z", "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"})};
const std::vector<FilePart> kFlat{part({"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z"})};

TEST(Layers, Blender) {
  EXPECT_THAT(color(kBlender), ElementsAre("ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                                           "ViewLayer.Combined.A"));
  EXPECT_THAT(depth(kBlender), ElementsAre("ViewLayer.Depth.Z"));
  EXPECT_THAT(normal(kBlender), ElementsAre("ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"));
}

TEST(Layers, AColourThatIsNotThereIsBlack) {
  EXPECT_THAT(color({part({"G", "R"})}), ElementsAre("R", "G", "-", "-"));
  EXPECT_THAT(color({part({"A", "B", "R"})}), ElementsAre("R", "-", "B", "A"));
  EXPECT_THAT(color({part({"s.A", "s.B", "s.G"})}, "s"), ElementsAre("-", "s.G", "s.B", "s.A"));
  EXPECT_THAT(color({part({"s.B", "s.G"})}, "s"), ElementsAre("-", "s.G", "s.B", "-"));
  EXPECT_THAT(color({part({"R"})}), ElementsAre("R", "R", "R", "-")) << "grey";
  EXPECT_THAT(color({part({"s.A", "s.B"})}, "s"), ElementsAre("s.B", "s.B", "s.B", "s.A")) << "grey";
  EXPECT_THAT(color({part({"s.A", "s.B", "s.C"})}, "s"), ElementsAre("s.A", "s.B", "s.C", "-")) << "names of nobody";
}

TEST(Layers, PlainNames) {
  EXPECT_THAT(color(kFlat), ElementsAre("R", "G", "B", "A"));
  EXPECT_THAT(depth(kFlat), ElementsAre("Z"));
  EXPECT_THAT(normal(kFlat), ElementsAre("N.X", "N.Y", "N.Z"));
  EXPECT_THAT(color({part({"Y"})}), ElementsAre("Y", "Y", "Y", "-"));
  EXPECT_THAT(color({part({"Y", "A"})}), ElementsAre("Y", "Y", "Y", "A"));
  EXPECT_THAT(depth({part({"R", "G", "B", "depth.Z"})}), ElementsAre("depth.Z"));
  EXPECT_THAT(depth({part({"R", "G", "B", "depth"})}), ElementsAre("depth"));
  EXPECT_THAT(normal({part({"R", "G", "B", "NX", "NY", "NZ"})}), ElementsAre("NX", "NY", "NZ"));
}

TEST(Layers, SeveralThatLookAlikeAreTold) {
  const auto equal = [](const std::vector<std::string>& channels) {
    return equal_colors(
        {{.name = "", .channels = channels, .data_window = {}, .display_window = {}, .unreadable = ""}});
  };
  EXPECT_THAT(equal({"diffuse.R", "diffuse.G", "diffuse.B", "specular.R", "specular.G", "specular.B"}),
              testing::ElementsAre("diffuse", "specular"));
  EXPECT_TRUE(equal({"R", "G", "B", "specular.R", "specular.G", "specular.B"}).empty());
  EXPECT_TRUE(equal({"beauty.R", "beauty.G", "beauty.B", "specular.R", "specular.G", "specular.B"}).empty());
  EXPECT_TRUE(equal({"diffuse.R", "diffuse.G", "diffuse.B"}).empty());
}

TEST(Layers, VectorsAreNoDepth) {
  EXPECT_THAT(depth({part({"R", "G", "B", "N.X", "N.Y", "N.Z", "Position.X", "Position.Y", "Position.Z"})}),
              ElementsAre());
  EXPECT_THAT(normal({part({"R", "G", "B", "Position.X", "Position.Y", "Position.Z"})}), ElementsAre());
}

TEST(Layers, PartsByName) {
  const std::vector<FilePart> parts{part({"R", "G", "B"}, "N"), part({"Z"}, "depth"),
                                    part({"R", "G", "B", "A"}, "rgba"), part({"R", "G", "B"}, "diffuse")};
  EXPECT_THAT(color(parts), ElementsAre("rgba/R", "rgba/G", "rgba/B", "rgba/A"));
  EXPECT_THAT(depth(parts), ElementsAre("depth/Z"));
  EXPECT_THAT(normal(parts), ElementsAre("N/R", "N/G", "N/B"));
  EXPECT_THAT(color(parts, "diffuse"), ElementsAre("diffuse/R", "diffuse/G", "diffuse/B", "-"));
  EXPECT_THAT(color(parts, "depth.Z"), ElementsAre("depth/Z", "depth/Z", "depth/Z", "-"));
}

TEST(Layers, DepthOfTheColoursOwnViewLayer) {
  const std::vector<FilePart> parts{
      part({"Back.Combined.R", "Back.Combined.G", "Back.Combined.B", "Back.Depth.Z", "Front.Combined.R",
            "Front.Combined.G", "Front.Combined.B", "Front.Depth.Z"})};
  const auto front = find_color(parts, "Front").value();
  EXPECT_THAT(chosen(parts, front), ElementsAre("Front.Combined.R", "Front.Combined.G", "Front.Combined.B", "-"));
  EXPECT_THAT(chosen(parts, *find_depth(parts, "", &front).value()), ElementsAre("Front.Depth.Z"));
}

TEST(Layers, MistIsNoDepthAndThatOfDenoisersComesLast) {
  const auto file = [](const std::vector<std::string>& more) {
    Names channels{"V.Combined.R", "V.Combined.G", "V.Combined.B"};
    channels.insert(channels.end(), more.begin(), more.end());
    return std::vector<FilePart>{part(channels)};
  };
  EXPECT_THAT(depth(file({"V.Denoising Depth.Z", "V.Depth.Z", "V.Mist.Z"})), ElementsAre("V.Depth.Z"));
  EXPECT_THAT(depth(file({"V.Denoising Depth.Z", "V.Mist.Z", "W.Depth.Z"})), ElementsAre("V.Denoising Depth.Z"))
      << "another view layer has other things";
  EXPECT_THAT(depth(file({"V.Mist.Z"})), testing::IsEmpty());
  EXPECT_THAT(depth(file({"V.Mist.Z"}), "Mist"), ElementsAre("V.Mist.Z")) << "if it is asked for";
}

TEST(Layers, DepthOfTheColoursOwnEye) {
  const std::vector<FilePart> parts{part({"R", "G", "B"}, "rgba.left"), part({"Z"}, "depth.left"),
                                    part({"R", "G", "B"}, "rgba.right"), part({"Z"}, "depth.right")};
  const std::vector<FilePart> one{part({"R", "G", "B", "Z", "depth.right.Z", "right.R", "right.G", "right.B"})};
  const std::vector<FilePart> own{part({"R", "G", "B", "Z", "right.R", "right.G", "right.B", "right.Z"})};
  const std::vector<FilePart> layers{
      part({"A.Combined.left.R", "A.Combined.left.G", "A.Combined.left.B", "A.Combined.right.R", "A.Combined.right.G",
            "A.Combined.right.B", "A.Depth.left.Z", "A.Depth.right.Z", "B.Depth.right.Z"})};
  const auto of = [](const std::vector<FilePart>& file, const std::string& layer) {
    const ChannelChoice colour = find_color(file, layer).value();
    return chosen(file, *find_depth(file, "", &colour).value());
  };
  EXPECT_THAT(of(parts, "rgba.left"), ElementsAre("depth.left/Z"));
  EXPECT_THAT(of(parts, "rgba.right"), ElementsAre("depth.right/Z"));
  EXPECT_THAT(of(one, ""), ElementsAre("Z"));
  EXPECT_THAT(of(one, "right"), ElementsAre("depth.right.Z"));
  EXPECT_THAT(of(own, "right"), ElementsAre("right.Z"));
  EXPECT_THAT(of(layers, "A.Combined.right"), ElementsAre("A.Depth.right.Z"));
}

TEST(Layers, ByName) {
  EXPECT_THAT(color(kBlender, "ViewLayer.Combined"), color(kBlender));
  EXPECT_THAT(color(kBlender, "ViewLayer"), color(kBlender));
  EXPECT_THAT(color(kBlender, "ViewLayer.Normal"),
              ElementsAre("ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z", "-"));
  EXPECT_THAT(color(kBlender, "ViewLayer.Depth.Z"),
              ElementsAre("ViewLayer.Depth.Z", "ViewLayer.Depth.Z", "ViewLayer.Depth.Z", "-"));
  EXPECT_THAT(depth(kBlender, "ViewLayer.Depth"), ElementsAre("ViewLayer.Depth.Z"));
  EXPECT_THAT(depth(kBlender, "ViewLayer.Normal.X"), ElementsAre("ViewLayer.Normal.X"));
  EXPECT_THAT(depth(kBlender, "ViewLayer"), ElementsAre("ViewLayer.Depth.Z"));
  EXPECT_THAT(normal(kBlender, "ViewLayer.Combined"),
              ElementsAre("ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"));
}

TEST(Layers, UnknownNamesListWhatIsThere) {
  const auto wrong = find_color(kBlender, "ViewLayer.Combind");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, ErrorKind::io);
  EXPECT_EQ(wrong.error().nearest, "ViewLayer.Combined");
  EXPECT_THAT(wrong.error().allowed, HasSubstr("ViewLayer.Depth"));
  EXPECT_EQ(find_depth(kFlat, "z", nullptr).error().nearest, "Z");
  EXPECT_EQ(find_normal(kFlat, "M", nullptr).error().kind, ErrorKind::io);
}

TEST(Layers, NoColour) {
  EXPECT_THAT(find_color({part({"Z"})}, "").error().message, HasSubstr("--layer"));
  EXPECT_THAT(find_color({part({"N.X", "N.Y", "N.Z"})}, "").error().allowed, HasSubstr("N.X"));
  EXPECT_THAT(find_color({part({})}, "").error().message, HasSubstr("no channels"));
}

TEST(Layers, UnreadableParts) {
  FilePart deep = part({"R", "G", "B", "A", "Z"}, "smoke");
  deep.unreadable = "is a deep EXR";
  EXPECT_EQ(find_color({deep}, "").error().message, "is a deep EXR");
  EXPECT_THAT(color({deep, part({"R", "G", "B"}, "flat")}), ElementsAre("flat/R", "flat/G", "flat/B", "-"));
  EXPECT_EQ(find_color({deep, part({"R", "G", "B"}, "flat")}, "smoke").error().message, "is a deep EXR");
}

TEST(Layers, OddNames) {
  EXPECT_THAT(color({part({"red", "green", "blue", "alpha"})}), ElementsAre("red", "green", "blue", "alpha"));
  EXPECT_THAT(color({part({"channel0"})}), ElementsAre("channel0", "channel0", "channel0", "-"));
  EXPECT_THAT(color({part({"left.R", "left.G", "left.B", "right.R", "right.G", "right.B"})}),
              ElementsAre("left.R", "left.G", "left.B", "-"));
  EXPECT_THAT(color({part({".R", ".G", ".B", "."})}), testing::SizeIs(4));
}

}  // namespace
}  // namespace afterglow
