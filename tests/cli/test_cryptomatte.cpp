// SPDX-License-Identifier: MIT
// A whole file of Blender's, with its cryptomattes by object and by material: masks are what Blender's own Cryptomatte
// node makes of the same file (tests/images/blender/cryptomatte.py made both).
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagecache.h>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class CryptomatteFile : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("effects/flat.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.effect { name = \"flat\", settings = { level = fx.float { default = 0 } },\n"
          "  build = function(g, s, source) return g:pass { shader = \"flat\", source = source, level = s.level } end "
          "}\n");
    write("shaders/flat.glsl", "uniform float level;\nvec4 apply(vec4 color) { return vec4(vec3(level), color.a); }\n");
  }
  static std::string image(const std::string& name) {
    return (fs::path(AFTERGLOW_TEST_FOLDER) / "images" / "blender" / name).string();
  }
  /// A picture that is the mask.
  Outcome run_mask(const std::string& mask) const {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.flat {}, fx.flat { level = 1, mask = " +
                          mask + " } }\n");
    return run({"run", "look.lua", image("cryptomatte.exr"), "-o", "mask.exr", "--type", "float"});
  }
  /// The largest difference between the mask and a channel of Blender's mattes; 1 where either is not there.
  double difference(const std::string& matte, bool inverted = false) const {
    OIIO::ImageCache::create()->invalidate_all(true);  // a file of this name was read before
    const OIIO::ImageBuf made(text("mask.exr")), mattes(image("cryptomatte_mattes.exr"));
    const int channel = mattes.spec().channelindex(matte + ".V"), red = made.spec().channelindex("R");
    if (channel < 0 || red < 0 || made.spec().width != mattes.spec().width) return 1;
    double worst = 0, sum = 0;
    for (int y = 0; y < mattes.spec().height; ++y)
      for (int x = 0; x < mattes.spec().width; ++x) {
        const double wanted = mattes.getchannel(x, y, 0, channel);
        sum += wanted;
        worst = std::max(worst, std::abs((inverted ? 1 - wanted : wanted) - made.getchannel(x, y, 0, red)));
      }
    return sum > 0 ? worst : 1;
  }
};

TEST_F(CryptomatteFile, MasksAreBlendersMattes) {
  const struct {
    std::string names, layer, matte;
  } cases[] = {
      {"\"Suzanne\"", "CryptoObject", "suzanne"},
      {"\"Kugel groß\"", "CryptoObject", "ball"},
      {"\"Kugel groß, Lamp.001\"", "CryptoObject", "two"},
      {"'The \"floor\"'", "CryptoObject", "floor"},  // as it is in the file, whose manifest is no JSON by that
      {"\"Bronze\"", "CryptoMaterial", "bronze"},
      {"\"Stone\"", "ViewLayer.CryptoMaterial", "stone"},
      {"'\"Glass, red\"'", "CryptoMaterial", "red"},  // a name with a comma stands in quotation marks
  };
  for (const auto& [names, layer, matte] : cases) {
    const Outcome outcome = run_mask("fx.mask.cryptomatte { names = " + names + ", layer = \"" + layer + "\" }");
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("warning"))) << names;
    EXPECT_LE(difference(matte), 2e-6) << names;
  }
  ASSERT_EQ(run_mask("fx.mask.cryptomatte { names = \"Suzanne\", invert = true }").exit_code, kDone);
  EXPECT_LE(difference("suzanne", true), 2e-6);
}

TEST_F(CryptomatteFile, WrongNamesAreNamedWithTheNearest) {
  const Outcome object = run_mask("fx.mask.cryptomatte { names = \"Susanne\" }");
  EXPECT_EQ(object.exit_code, kDone);
  EXPECT_THAT(object.err, HasSubstr("the cryptomatte 'CryptoObject' has no 'Susanne'; did you mean 'Suzanne'?"));
  EXPECT_EQ(difference("suzanne"), 1) << "it covers nothing";
  const Outcome layer = run_mask("fx.mask.cryptomatte { names = \"Suzanne\", layer = \"CryptoObjekt\" }");
  EXPECT_THAT(layer.err, HasSubstr("no layer:CryptoObjekt00 input; the picture has the layers "));
  EXPECT_THAT(layer.err, HasSubstr("ViewLayer.CryptoObject00"));
}

}  // namespace
}  // namespace afterglow::test
