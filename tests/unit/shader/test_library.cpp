// SPDX-License-Identifier: MIT
// Finding shaders and their includes on disk.
#include <gmock/gmock.h>

#include "shader/scan.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kSimple = "vec4 apply(vec4 color) { return color; }\n";

std::vector<std::string> include_names(const ShaderSource& source) {
  std::vector<std::string> out;
  for (const auto& include : source.includes) out.push_back(include.name);
  return out;
}

TEST(ShaderLibrary, FindsOnceAndForgetsOnReload) {
  ShaderFiles files;
  files.write("fx/a.glsl", kSimple);
  ShaderLibrary library(files.search());
  const auto first = library.find("fx/a");
  ASSERT_TRUE(first.ok()) << first.error().text();
  EXPECT_EQ((*first)->name, "fx/a");
  EXPECT_EQ((*first)->path, files.path("fx/a.glsl"));
  EXPECT_EQ((*first)->file->text, kSimple);
  files.write("fx/a.glsl", std::string("uniform float t;\n") + kSimple);
  EXPECT_EQ(*library.find("fx/a"), *first);
  library.reload();
  const auto second = library.find("fx/a");
  ASSERT_TRUE(second.ok());
  EXPECT_EQ((*second)->interface.params.size(), 1u);
  EXPECT_NE((*second)->hash, (*first)->hash);
}

TEST(ShaderLibrary, KnowsWhichShadersLoop) {
  ShaderFiles files;
  files.write("lib/sum.glsl",
              "float sum(vec4 v) { float s = 0.0; for (int i = 0; i < 4; ++i) s += v[i]; return s; }\n");
  const std::string do_not = "// for once, while we do it\n";
  EXPECT_FALSE((*files.find("straight", do_not + kSimple))->loops);
  EXPECT_TRUE((*files.find("own", "vec4 apply(vec4 c) { while (c.r > 1.0) c *= 0.5; return c; }"))->loops);
  EXPECT_TRUE((*files.find("included", std::string("#include \"lib/sum.glsl\"\n") + kSimple))->loops);
}

TEST(ShaderLibrary, AnErrorIsNotRemembered) {
  ShaderFiles files;
  files.write("a.glsl", "oops");
  ShaderLibrary library(files.search());
  EXPECT_FALSE(library.find("a").ok());
  files.write("a.glsl", kSimple);
  EXPECT_TRUE(library.find("a").ok());
}

TEST(ShaderLibrary, UnknownNamesGetTheNearest) {
  ShaderFiles files;
  files.write("bloom/threshold.glsl", kSimple);
  files.write("lib/treshold.glsl", "");
  ShaderLibrary library(files.search());
  const auto result = library.find("bloom/treshold");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().text(),
            "error: unknown shader 'bloom/treshold'; allowed: shaders/bloom/treshold.glsl beside the preset, or on the "
            "search path; did you mean 'bloom/threshold'?");
  EXPECT_EQ(result.error().kind, ErrorKind::script);
  EXPECT_EQ(library.find("bloom/threshold.glsl").error().nearest, "bloom/threshold");
  EXPECT_THAT(library.names(), ElementsAre("bloom/threshold"));
}

TEST(ShaderLibrary, NamesStayBelowTheShaderFolders) {
  ShaderFiles files;
  files.write("a.glsl", kSimple);
  files.write("../secret.glsl", kSimple);
  ShaderLibrary library(files.search());
  for (const std::string name : {"../secret", "./a", "x/../a", "/etc/passwd", "", "a/", "a\\b"})
    EXPECT_FALSE(library.find(name).ok()) << name;
  EXPECT_TRUE(library.find("a").ok());
}

TEST(ShaderLibrary, EarlierFoldersShadowLaterOnes) {
  ShaderFiles first, second;
  second.write("a.glsl", kSimple);
  second.write("lib/x.glsl", "float x() { return 2.0; }\n");
  second.write("b.glsl", std::string("#include \"lib/x.glsl\"\n") + kSimple);
  SearchPath search;
  search.user = {first.root()};
  search.installation = second.root();
  EXPECT_EQ((*ShaderLibrary(search).find("a"))->path, second.path("a.glsl"));
  first.write("a.glsl", kSimple);
  first.write("lib/x.glsl", "float x() { return 1.0; }\n");
  EXPECT_EQ((*ShaderLibrary(search).find("a"))->path, first.path("a.glsl"));
}

TEST(ShaderLibrary, AFileIncludesWhatLiesInItsOwnFolderFirst) {
  const std::string includes = std::string("#include \"lib/x.glsl\"\n") + kSimple;
  ShaderFiles preset, pack, installation;
  SearchPath search;
  search.user = {preset.root(), pack.root()};
  search.installation = installation.root();
  preset.write("own.glsl", includes);
  pack.write("of_pack.glsl", includes);
  installation.write("built_in.glsl", includes);
  const auto included = [&](const char* shader) {
    const auto found = ShaderLibrary(search).find(shader);
    return found ? (*found)->includes.at(0).path : std::filesystem::path(found.error().text());
  };
  installation.write("lib/x.glsl", "float x() { return 1.0; }\n");
  EXPECT_EQ(included("own"), installation.path("lib/x.glsl"));
  EXPECT_EQ(included("of_pack"), installation.path("lib/x.glsl"));
  preset.write("lib/x.glsl", "float x() { return 2.0; }\n");
  EXPECT_EQ(included("own"), preset.path("lib/x.glsl"));
  EXPECT_EQ(included("of_pack"), preset.path("lib/x.glsl")) << "its own folder has none: in the order of the path";
  EXPECT_EQ(included("built_in"), installation.path("lib/x.glsl"));
  pack.write("lib/x.glsl", "float x() { return 3.0; }\n");
  EXPECT_EQ(included("of_pack"), pack.path("lib/x.glsl"));
  EXPECT_EQ(included("own"), preset.path("lib/x.glsl"));
}

TEST(ShaderLibrary, AByteOrderMarkIsDropped) {
  ShaderFiles files;
  EXPECT_EQ((*files.find("a", std::string("\xEF\xBB\xBF") + kSimple))->file->text, kSimple);
}

TEST(ShaderLibrary, IncludesStandOnceAndInOrder) {
  ShaderFiles files;
  files.write("lib/base.glsl", "float base() { return 1.0; }\n");
  files.write("lib/left.glsl", "#include \"lib/base.glsl\"\nfloat left() { return base(); }\n");
  files.write("lib/right.glsl", "#include \"lib/base.glsl\"\nfloat right() { return base(); }\n");
  const auto source = files.find(
      "fx/a",
      std::string("#include \"lib/left.glsl\"\n#include \"lib/right.glsl\"\n#include \"lib/left.glsl\"\n") + kSimple);
  ASSERT_TRUE(source.ok()) << source.error().text();
  EXPECT_THAT(include_names(**source), ElementsAre("lib/base.glsl", "lib/left.glsl", "lib/right.glsl"));
  EXPECT_THAT((*source)->includes[0].uses, ElementsAre());
  EXPECT_THAT((*source)->includes[2].uses, ElementsAre(0u));
  EXPECT_THAT((*source)->includes[2].global_names, ElementsAre("right"));
  EXPECT_THAT((*source)->files(), ElementsAre(files.path("fx/a.glsl"), files.path("lib/base.glsl"),
                                              files.path("lib/left.glsl"), files.path("lib/right.glsl")));
}

TEST(ShaderLibrary, AFileBesideTheShaderComesFirst) {
  ShaderFiles files;
  files.write("helper.glsl", "float far() { return 1.0; }\n");
  files.write("fx/helper.glsl", "float near() { return 1.0; }\n");
  const auto source = files.find("fx/a", std::string("#include \"helper.glsl\"\n") + kSimple);
  ASSERT_TRUE(source.ok());
  EXPECT_EQ((*source)->includes.at(0).path, files.path("fx/helper.glsl"));
}

TEST(ShaderLibrary, OneFileUnderTwoNamesIsOneFile) {
  ShaderFiles files;
  files.write("fx/helper.glsl", "float near() { return 1.0; }\n");
  const auto source =
      files.find("fx/a", std::string("#include \"helper.glsl\"\n#include \"fx/helper.glsl\"\n") + kSimple);
  ASSERT_TRUE(source.ok()) << source.error().text();
  EXPECT_EQ((*source)->includes.size(), 1u);
}

TEST(ShaderLibrary, TheHashCoversIncludes) {
  ShaderFiles files;
  files.write("lib/x.glsl", "float x() { return 1.0; }\n");
  const std::string text = std::string("#include \"lib/x.glsl\"\n") + kSimple;
  const Hash before = (*files.find("a", text))->hash;
  EXPECT_EQ((*files.find("a", text))->hash, before);
  files.write("lib/x.glsl", "float x() { return 2.0; }\n");
  EXPECT_NE((*files.find("a", text))->hash, before);
}

TEST(ShaderLibrary, IncludeErrorsAreAtTheirOwnFileAndLine) {
  ShaderFiles files;
  files.write("lib/color.glsl", "float luminance(vec3 c) { return c.g; }\n");
  const auto message = [&](const std::string& text) {
    const auto result = files.find("fx/a", text + kSimple);
    return result.ok() ? std::string("ok") : result.error().text();
  };
  const std::string a = files.path("fx/a.glsl").string();
  EXPECT_EQ(message("\n#include \"lib/colour.glsl\"\n"),
            a + ":2: error: cannot find the include 'lib/colour.glsl'; did you mean 'lib/color.glsl'?");
  EXPECT_THAT(message("#include \"../lib/color.glsl\"\n"),
              HasSubstr(a + ":1: error: '../lib/color.glsl' cannot be included; allowed: "));
  EXPECT_THAT(message("#include \"/etc/passwd\"\n"), HasSubstr("cannot be included"));
  EXPECT_THAT(message("#include \"lib/color\"\n"), HasSubstr("cannot be included"));
  EXPECT_THAT(message("#include \"lib/color.glsl\"\nfloat luminance(vec3 c) { return c.r; }\n"),
              HasSubstr(a + ":2: error: 'luminance' is already defined by lib/color.glsl"));
  files.write("lib/again.glsl", "float luminance(vec2 c) { return c.r; }\n");
  EXPECT_THAT(message("#include \"lib/color.glsl\"\n#include \"lib/again.glsl\"\n"),
              HasSubstr("'luminance' is defined by both lib/color.glsl and lib/again.glsl"));
  files.write("lib/bad.glsl", "\n\nuniform float t;\n");
  EXPECT_THAT(message("#include \"lib/bad.glsl\"\n"),
              HasSubstr(files.path("lib/bad.glsl").string() + ":3: error: a library declares no uniforms"));
}

TEST(ShaderLibrary, IncludeCyclesAreRefused) {
  ShaderFiles files;
  files.write("lib/a.glsl", "#include \"lib/b.glsl\"\n");
  files.write("lib/b.glsl", "\n#include \"lib/a.glsl\"\n");
  const auto cycle = files.find("fx/x", std::string("#include \"lib/a.glsl\"\n") + kSimple);
  ASSERT_FALSE(cycle.ok());
  EXPECT_THAT(cycle.error().text(), HasSubstr(files.path("lib/b.glsl").string() +
                                              ":2: error: 'lib/a.glsl' includes itself, directly or through others"));
  const auto self = files.find("fx/y", std::string("#include \"y.glsl\"\n") + kSimple);
  ASSERT_FALSE(self.ok());
  EXPECT_THAT(self.error().message, HasSubstr("includes itself"));
}

TEST(ShaderLibrary, ErrorsInIncludesTellWhoIncludesThem) {
  ShaderFiles files;
  files.write("lib/bad.glsl", "oops\n");
  files.write("lib/outer.glsl", "\n#include \"lib/bad.glsl\"\n");
  const auto source = files.find("fx/a", std::string("#include \"lib/outer.glsl\"\n") + kSimple);
  ASSERT_FALSE(source.ok());
  EXPECT_EQ(source.error().file, files.path("lib/bad.glsl").string());
  EXPECT_THAT(source.error().trail, ElementsAre("included at " + files.path("lib/outer.glsl").string() + ":2",
                                                "included at " + files.path("fx/a.glsl").string() + ":1"));
}

TEST(ShaderLibrary, MacrosMayBeDefinedAgain) {
  ShaderFiles files;
  files.write("lib/a.glsl", "#ifndef PI\n#define PI 3.0\n#endif\n");
  files.write("lib/b.glsl", "#ifndef PI\n#define PI 3.5\n#endif\n");
  EXPECT_TRUE(
      files.find("x", std::string("#include \"lib/a.glsl\"\n#include \"lib/b.glsl\"\n#define PI 4.0\n") + kSimple)
          .ok());
}

}  // namespace
}  // namespace afterglow
