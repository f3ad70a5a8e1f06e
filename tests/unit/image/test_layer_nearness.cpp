// SPDX-License-Identifier: MIT
// Depth, normals and motion of files with several view layers and eyes: what belongs to another picture is not taken.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/layers.h"

namespace afterglow::nearness_test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Names = std::vector<std::string>;
using Parts = std::vector<FilePart>;

FilePart part(Names channels, std::string name = "", std::string view = "", Names views = {}) {
  FilePart made;
  made.name = std::move(name);
  made.channels = std::move(channels);
  made.view = std::move(view);
  made.views = std::move(views);
  return made;
}

Names with(Names channels, const Names& more) {
  channels.insert(channels.end(), more.begin(), more.end());
  return channels;
}
Names rgb(const std::string& layer) { return {layer + "R", layer + "G", layer + "B"}; }
Names xyz(const std::string& layer) { return {layer + "X", layer + "Y", layer + "Z"}; }

using Found = Result<std::optional<ChannelChoice>>;
std::string text(const Parts& parts, const Found& found) {
  if (!found) return found.error().message;
  return found.value() ? choice_text(parts, *found.value()) : "none";
}
std::string depth(const Parts& parts, const std::string& layer, const std::string& name = "") {
  const ChannelChoice color = find_color(parts, layer).value();
  return text(parts, find_depth(parts, name, &color));
}
std::string normal(const Parts& parts, const std::string& layer, const std::string& name = "") {
  const ChannelChoice color = find_color(parts, layer).value();
  return text(parts, find_normal(parts, name, &color));
}
std::string matte(const Parts& parts, const std::string& layer, const std::string& name) {
  const ChannelChoice color = find_color(parts, layer).value();
  return text(parts, find_layer(parts, name, &color));
}
Names equal_depths(const Parts& parts, const std::string& layer) {
  const ChannelChoice color = find_color(parts, layer).value();
  const ChannelChoice found = *find_depth(parts, "", &color).value();
  Names names;
  for (const ChannelChoice& other : found.equal) names.push_back(choice_name(parts, other));
  return names;
}

TEST(LayerNearness, DepthOfAnotherViewLayerIsNotTaken) {
  const Parts parts{part(with(with(rgb("ViewLayer.Combined."), rgb("ViewLayer_fg.Combined.")),
                              with({"ViewLayer.Depth.Z", "ViewLayer.IndexOB.X"}, xyz("ViewLayer.Normal."))))};
  EXPECT_EQ(depth(parts, "ViewLayer"), "ViewLayer.Depth.Z");
  EXPECT_EQ(depth(parts, "ViewLayer_fg"), "none");
  EXPECT_EQ(normal(parts, "ViewLayer_fg"), "none");
  EXPECT_EQ(matte(parts, "ViewLayer", "IndexOB"), "ViewLayer.IndexOB.X");
  EXPECT_EQ(depth(parts, "ViewLayer_fg", "ViewLayer.Depth.Z"), "ViewLayer.Depth.Z") << "it is asked for";
  EXPECT_EQ(normal(parts, "ViewLayer_fg", "ViewLayer.Normal"), "ViewLayer.Normal.XYZ");
  EXPECT_THAT(likely_names(parts, "depth"), ElementsAre("ViewLayer.Depth.Z"));
  EXPECT_THAT(likely_names(parts, "normal"), ElementsAre("ViewLayer.Normal"));
}

TEST(LayerNearness, EndsOfNamesAreThoseOfTheColoursLayer) {
  Names channels;
  for (const std::string layer : {"A", "B"})
    channels = with(with(channels, rgb(layer + ".Combined.")), {layer + ".Depth.Z", layer + ".IndexOB.X"});
  const Parts parts{part(channels)};
  EXPECT_EQ(depth(parts, "B", "Z"), "B.Depth.Z");
  EXPECT_EQ(depth(parts, "B", "Depth"), "B.Depth.Z");
  EXPECT_EQ(matte(parts, "A", "IndexOB"), "A.IndexOB.X");
  EXPECT_EQ(matte(parts, "B", "IndexOB"), "B.IndexOB.X");
  EXPECT_EQ(matte(parts, "B", "A.IndexOB"), "A.IndexOB.X");
}

TEST(LayerNearness, ALayerKeepsTheDepthBesideItsColours) {
  const Parts parts{part(with(with(rgb("fg."), rgb("bg.")), {"bg.Z"}))};
  EXPECT_EQ(depth(parts, "bg"), "bg.Z");
  EXPECT_EQ(depth(parts, "fg"), "none");
  const Parts by_part{part(with(rgb(""), with({"Z"}, xyz("N."))), "fg"), part(rgb(""), "bg")};
  EXPECT_EQ(depth(by_part, "fg"), "fg.Z");
  EXPECT_EQ(depth(by_part, "bg"), "none");
  EXPECT_EQ(normal(by_part, "bg"), "none");
  const Parts passes{part(with(rgb(""), {"Z"}), "rgba"), part(rgb(""), "diffuse")};
  EXPECT_EQ(depth(passes, "diffuse"), "rgba.Z") << "what stands with the picture is that of its passes";
}

TEST(LayerNearness, EyesInPartsOfTheSameNames) {
  const auto eye = [](const std::string& name, bool deep) {
    Names channels = with(rgb("ViewLayer.Combined."), {"ViewLayer.IndexOB.X"});
    if (deep) channels = with(channels, with({"ViewLayer.Depth.Z"}, xyz("ViewLayer.Normal.")));
    return part(channels, name, name);
  };
  const Parts both{eye("left", true), eye("right", true)}, cameras{eye("camA", true), eye("camB", true)};
  EXPECT_EQ(depth(both, "left"), "left.ViewLayer.Depth.Z");
  EXPECT_EQ(depth(both, "right"), "right.ViewLayer.Depth.Z");
  EXPECT_EQ(depth(both, "right", "ViewLayer.Depth.Z"), "right.ViewLayer.Depth.Z") << "the name is that of both";
  EXPECT_EQ(depth(both, "right", "left.ViewLayer.Depth.Z"), "left.ViewLayer.Depth.Z");
  EXPECT_EQ(normal(both, "right"), "right.ViewLayer.Normal.XYZ");
  EXPECT_EQ(normal(both, "right", "Normal"), "right.ViewLayer.Normal.XYZ");
  EXPECT_EQ(matte(both, "right", "IndexOB"), "right.ViewLayer.IndexOB.X");
  EXPECT_EQ(depth(cameras, "camB"), "camB.ViewLayer.Depth.Z");
  const Parts one{eye("left", true), eye("right", false)};
  EXPECT_EQ(depth(one, "right"), "none");
  EXPECT_EQ(normal(one, "right"), "none");
  EXPECT_THAT(depth(one, "right", "ViewLayer.Depth.Z"), HasSubstr("has no depth channel"));
  EXPECT_EQ(depth(one, "right", "left.ViewLayer.Depth.Z"), "left.ViewLayer.Depth.Z");
  EXPECT_THAT(equal_colors(both), ElementsAre("left.ViewLayer.Combined", "right.ViewLayer.Combined"));
}

TEST(LayerNearness, EyesOfOnePart) {
  const Names channels = with(with(rgb(""), rgb("right.")), with({"Z"}, xyz("N.right.")));
  const Parts said{part(channels, "", "", {"left", "right"})}, unsaid{part(channels)};
  for (const Parts& parts : {said, unsaid}) {
    EXPECT_EQ(depth(parts, ""), "Z");
    EXPECT_EQ(depth(parts, "right"), "none");
    EXPECT_EQ(depth(parts, "right", "Z"), "Z") << "it is asked for";
    EXPECT_EQ(normal(parts, "right"), "N.right.XYZ");
    EXPECT_EQ(normal(parts, ""), "none");
    EXPECT_EQ(depth(parts, "left"), "Z") << "the eye of plain names";
  }
  const Parts common{part(with(with(rgb("left."), rgb("right.")), {"Z"}))};
  EXPECT_EQ(depth(common, "right"), "Z") << "of no eye";
}

TEST(LayerNearness, TheEyeOfPlainNamesIsThePicture) {
  const Parts parts{part(with(rgb("A."), rgb("")), "", "", {"main", "A"})};
  EXPECT_EQ(choice_text(parts, find_color(parts, "").value()), "RGB");
}

TEST(LayerNearness, ACompositeHasTheDepthOfItsOnlyLayer) {
  const Names one = with(with(rgb("Composite.Combined."), rgb("ViewLayer.Combined.")), {"ViewLayer.Depth.Z"});
  const Parts parts{part(one)}, two{part(with(one, {"Other.Depth.Z"}))};
  EXPECT_EQ(depth(parts, ""), "ViewLayer.Depth.Z");
  EXPECT_THAT(equal_depths(parts, ""), IsEmpty());
  EXPECT_THAT(equal_colors(parts), IsEmpty()) << "the composite is the picture";
  EXPECT_EQ(depth(two, ""), "ViewLayer.Depth.Z") << "the first";
  EXPECT_THAT(equal_depths(two, ""), ElementsAre("Other.Depth.Z"));
}

TEST(LayerNearness, OthersAsNearAreTold) {
  const Parts parts{part(with(rgb(""), {"depth.Z", "zdepth.Z"}))};
  EXPECT_EQ(depth(parts, ""), "depth.Z");
  EXPECT_THAT(equal_depths(parts, ""), ElementsAre("zdepth.Z"));
  const Parts own{part(with(rgb(""), {"Z", "depth.Z"}))};
  EXPECT_THAT(equal_depths(own, ""), IsEmpty());
}

TEST(LayerNearness, NamesWithCommasAndSpacesAreListedInQuotationMarks) {
  const Parts parts{part(with(rgb("key light, warm."), rgb("fill.")))};
  EXPECT_EQ(choice_text(parts, find_color(parts, "key light, warm").value()), "key light, warm.RGB");
  const auto missing = find_color(parts, "key light");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().allowed, HasSubstr("'key light, warm', fill, 'key light, warm.R'"));
  EXPECT_EQ(missing.error().nearest, "key light, warm");
}

TEST(LayerNearness, AnotherFileIsAskedForTheSameEye) {
  const Parts color{part(rgb(""), "left", "left"), part(rgb(""), "right", "right")};
  const Parts depths{part({"Z"}, "left", "left"), part({"Z"}, "right", "right")};
  const ChannelChoice right = find_color(color, "right").value();
  EXPECT_EQ(text(depths, find_depth(depths, "", {&right, &color})), "right.Z");
  EXPECT_EQ(text(depths, find_depth(depths, "Z", {&right, &color})), "right.Z");
  const Parts layers{part({"A.Depth.Z", "B.Depth.Z"})}, plain{part(rgb(""))};
  const ChannelChoice mono = find_color(plain, "").value();
  const auto found = find_depth(layers, "", {&mono, &plain});
  EXPECT_EQ(text(layers, found), "A.Depth.Z");
  EXPECT_EQ(found.value()->equal.size(), 1u) << "which is told";
}

}  // namespace
}  // namespace afterglow::nearness_test
