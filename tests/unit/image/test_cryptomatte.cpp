// SPDX-License-Identifier: MIT
// Ids and manifests of cryptomattes, by the specification.
#include <gtest/gtest.h>

#include <bit>

#include "image/cryptomatte.h"
#include "image/layers.h"

namespace afterglow {
namespace {

float id(const char* name) { return std::bit_cast<float>(cryptomatte_id(name)); }

// Values of Psyop's own tests (Cryptomatte, tests of mm3hash_float).
TEST(CryptomatteTest, IdsAreThoseOfTheSpecification) {
  EXPECT_FLOAT_EQ(id("hello"), 6.0705627102400005616e-17f);
  EXPECT_FLOAT_EQ(id("cube"), -4.08461912519e+15f);
  EXPECT_FLOAT_EQ(id("sphere"), 2.79018604383e+15f);
  EXPECT_FLOAT_EQ(id("plane"), 3.66557617593e-11f);
}

TEST(CryptomatteTest, IdsAreOrdinaryNumbers) {
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t bits = cryptomatte_id("object" + std::to_string(i)), exponent = bits >> 23 & 255;
    EXPECT_TRUE(exponent != 0 && exponent != 255) << i;
  }
}

TEST(CryptomatteTest, ManifestsGiveIdsByName) {
  const Metadata metadata{
      {"cryptomatte/9e7aab0/name", std::string("ViewLayer.CryptoObject")},
      {"cryptomatte/9e7aab0/hash", std::string("MurmurHash3_32")},
      {"cryptomatte/9e7aab0/conversion", std::string("uint32_to_float32")},
      {"cryptomatte/9e7aab0/manifest", std::string(R"({"Lamp":"0d362c75","A \"sign\"":"fff00001"})")},
      {"cryptomatte/1234567/name", std::string("ViewLayer.CryptoMaterial")}};
  for (const char* layer : {"CryptoObject", "ViewLayer.CryptoObject"}) {
    const auto found = find_cryptomatte(metadata, layer);
    ASSERT_TRUE(found && *found);
    EXPECT_EQ((*found)->layer, "ViewLayer.CryptoObject");
    EXPECT_EQ((*found)->manifest.at("Lamp"), 0x0d362c75u);
    EXPECT_EQ((*found)->manifest.at("A \"sign\""), 0xfff00001u);
  }
  const auto without = find_cryptomatte(metadata, "CryptoMaterial");
  ASSERT_TRUE(without && *without);
  EXPECT_EQ((*without)->layer, "ViewLayer.CryptoMaterial");
  EXPECT_TRUE((*without)->manifest.empty());
  const auto none = find_cryptomatte(metadata, "Object");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

TEST(CryptomatteTest, NamesThatBlenderDoesNotEscapeAreRead) {
  const auto names = [](const char* manifest) {
    const auto found = find_cryptomatte(
        {{"cryptomatte/1/name", std::string("C")}, {"cryptomatte/1/manifest", std::string(manifest)}}, "C");
    return found && *found ? (*found)->manifest : std::map<std::string, std::uint32_t>{{found.error().message, 0}};
  };
  using Names = std::map<std::string, std::uint32_t>;
  EXPECT_EQ(names(R"({"a":"00000001","The "floor"":"4c1fd503"})"), (Names{{"a", 1}, {"The \"floor\"", 0x4c1fd503}}));
  EXPECT_EQ(names(R"({"x":"y":"00000002"})"), (Names{{"x\":\"y", 2}}));
  EXPECT_EQ(names(R"({"a":"00000001","b\"":"00000002"})"), (Names{{"a", 1}, {"b\"", 2}})) << "JSON";
}

TEST(CryptomatteTest, NamesHaveCommasBetweenThem) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(cryptomatte_names(" Lamp , Sign.001,, "), (Names{"Lamp", "Sign.001"}));
  EXPECT_EQ(cryptomatte_names(R"("Glass, red", The "floor", "a \"b\"" , "open)"),
            (Names{"Glass, red", "The \"floor\"", "a \"b\"", "open"}));
  EXPECT_EQ(cryptomatte_names(""), Names{});
}

TEST(CryptomatteTest, BrokenManifestsAreErrors) {
  for (const char* manifest :
       {"", "[1]", "{\"a\":3}", "{\"a\":\"xyz\"}", "{\"a\":\"\"}", "{\"a\":\"123456789\"}", "{\"a\"b\":\"0000000g\"}",
        "{\"a\"b\":\"00000001\",}", "{\"a\"b\":\"00000001\"", "{\"\"}"}) {
    const Metadata metadata{{"cryptomatte/1/name", std::string("C")},
                            {"cryptomatte/1/manifest", std::string(manifest)}};
    EXPECT_FALSE(find_cryptomatte(metadata, "C")) << manifest;
  }
}

FilePart blender() {
  FilePart part;
  for (const char* name : {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                           "ViewLayer.Combined.A", "ViewLayer.Depth.Z", "ViewLayer.Normal.X", "ViewLayer.Normal.Y",
                           "ViewLayer.Normal.Z", "ViewLayer.CryptoObject00.r", "ViewLayer.CryptoObject00.g",
                           "ViewLayer.CryptoObject00.b", "ViewLayer.CryptoObject00.a", "ViewLayer.Mist.Z"})
    part.channels.emplace_back(name);
  part.data_window = part.display_window = {0, 0, 4, 4};
  return part;
}

TEST(LayerNames, AreKnownByTheirEnd) {
  const std::vector<FilePart> parts{blender()};
  EXPECT_EQ(find_layer(parts, "CryptoObject00")->channels, (std::vector<int>{8, 9, 10, 11}));
  EXPECT_EQ(find_layer(parts, "ViewLayer.CryptoObject00")->channels, (std::vector<int>{8, 9, 10, 11}));
  EXPECT_EQ(find_layer(parts, "Normal")->channels, (std::vector<int>{5, 6, 7}));
  EXPECT_EQ(find_layer(parts, "Depth.Z")->channels, (std::vector<int>{4}));
  EXPECT_FALSE(find_layer(parts, "Z"));  // three end so
  EXPECT_FALSE(find_layer(parts, "rypto"));
  const auto depth = find_depth(parts, "Depth.Z", nullptr);
  ASSERT_TRUE(depth && *depth);
  EXPECT_EQ((*depth)->channels, (std::vector<int>{4}));
  const auto normal = find_normal(parts, "Normal", nullptr);
  ASSERT_TRUE(normal && *normal);
  EXPECT_EQ((*normal)->channels, (std::vector<int>{5, 6, 7}));
}

TEST(LayerNames, DepthIsFoundAmongThoseThatEndSo) {
  const FilePart part = blender();  // Mist is none
  const auto depth = find_depth({part}, "Z", nullptr);
  ASSERT_TRUE(depth && *depth);
  EXPECT_EQ((*depth)->channels, (std::vector<int>{4}));
  const auto several = find_color({part}, "Y");
  EXPECT_TRUE(several);  // one ends so
  const auto unsure = find_normal({part}, "Z", nullptr);
  ASSERT_FALSE(unsure);
  EXPECT_NE(unsure.error().message.find("has several of which each may be the normal layer 'Z'"), std::string::npos)
      << unsure.error().message;
}

}  // namespace
}  // namespace afterglow
