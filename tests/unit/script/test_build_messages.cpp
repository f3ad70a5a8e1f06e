// SPDX-License-Identifier: MIT
// What the author of an effect reads when `build` is wrong: file and line of the key, pass and effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;

using namespace std::string_literals;

struct BuildMessages : testing::Test {
  BuildMessages() {
    scene.write("shaders/gain.glsl",
                "uniform float gain;\nuniform vec3 tint;\nuniform int steps;\nuniform bool on;\n"
                "layout(constant_id = 0) const int taps = 5;\nvec4 apply(vec4 color, vec4 high) { return color; }\n");
    scene.write("shaders/plain.glsl", "vec4 apply(vec4 color) { return color; }\n");
    scene.write("shaders/lone.glsl",
                "uniform sampler2D depth;\nvec4 sample_at(ivec2 pixel) { return fetch(depth, pixel); }\n");
    scene.write("shaders/broken.glsl", "uniform float a\nvec4 apply(vec4 color) { return color; }\n");
  }
  // The statements begin at line 4.
  std::string error(const std::string& statements, const std::string& keys = "") {
    scene.effect("probe", "build = function(g, s, source)\n" + statements + "\nend," + keys);
    scene.stack("fx.probe { name = \"glow\" }");
    std::string text = scene.build_error();
    const std::string trail = "\n  in effect 'glow' of preset.lua:3";
    EXPECT_TRUE(text.ends_with(trail)) << text;
    return text.substr(0, text.size() - std::min(text.size(), trail.size()));
  }
  // A pass of shader gain with these further keys, which stand at line 5.
  std::string gain(const std::string& keys) {
    return error("return g:pass { shader = \"gain\", source = source,\n" + keys + " }");
  }
  Scene scene;
};

const std::string kAt5 = "effects/probe.lua:5: error: pass 'glow.gain' of effect 'probe': ";
const std::string kAt4 = "effects/probe.lua:4: error: pass 'glow.gain' of effect 'probe': ";
const std::string kRest = "high = source, tint = { 1, 1, 1 }, steps = 1, on = true";

TEST_F(BuildMessages, UnknownNames) {
  EXPECT_EQ(gain("high = source, gian = 1"),
            kAt5 +
                "shader 'gain' has no input or parameter 'gian' (shaders/gain.glsl); allowed: source, "
                "high, gain, tint, steps, on, taps, channels, compute, name, precise, reach, shader, size; "
                "did you mean 'gain'?");
  EXPECT_THAT(gain("high = source, chanels = 1"), HasSubstr("did you mean 'channels'?"));
  EXPECT_EQ(error("return g:pass { shader = \"plane\", source = source }").substr(0, 75),
            "effects/probe.lua:4: error: pass 'glow.plane' of effect 'probe': unknown shader 'plane'"s.substr(0, 75));
  EXPECT_EQ(error("return g:pass { source = source }"),
            "effects/probe.lua:4: error: effect 'probe': g:pass needs 'shader', the name of a shader");
  EXPECT_EQ(error("return g:pass { shader = \"plain\", source = source, 5 }"),
            "effects/probe.lua:4: error: effect 'probe': g:pass has a value without a name at position 1");
}

TEST_F(BuildMessages, Channels) {
  for (const std::string value : {"3", "0", "1.5", "-1"})
    EXPECT_EQ(gain(kRest + ", gain = 1, channels = " + value),
              kAt5 + "channels = " + value + " is no number of channels; allowed: 1, 2, 4");
  EXPECT_EQ(error("return g:filter { source = source, filter = {},\nchannels = 3 }"),
            "effects/probe.lua:5: error: pass 'glow.filter' of effect 'probe': channels = 3 is no number of channels; "
            "allowed: 1, 2, 4");
}

TEST_F(BuildMessages, MissingInputsAndParameters) {
  EXPECT_EQ(gain(""), kAt4 + "shader 'gain' needs 'high', an image");
  EXPECT_EQ(gain("high = source"), kAt4 + "shader 'gain' needs the parameter 'gain'; allowed: a number");
  EXPECT_EQ(gain("high = source, gain = 1"), kAt4 + "shader 'gain' needs the parameter 'tint'; allowed: { 3 numbers }");
  EXPECT_EQ(error("return g:pass { shader = \"plain\" }"),
            "effects/probe.lua:4: error: pass 'glow.plain' of effect 'probe': shader 'plain' needs 'source', an image");
  EXPECT_EQ(error("return g:pass { shader = \"lone\", size = source }"),
            "effects/probe.lua:4: error: pass 'glow.lone' of effect 'probe': shader 'lone' needs 'depth', an image");
}

TEST_F(BuildMessages, WaysByWorkgroups) {
  const std::string group = "layout(local_size_x = 8) in;\nuniform sampler2D depth;\n";
  const std::string entry = "vec4 compute_at(ivec2 pixel) { return fetch(depth, pixel); }\n";
  scene.write("shaders/group.glsl", group + entry);
  scene.write("shaders/other.glsl", group + "uniform float more;\n" + entry);
  const auto pass = [&](const std::string& shader, const std::string& compute) {
    return error("return g:pass { shader = \"" + shader +
                 "\", source = source, depth = source, size = source,\ncompute = \"" + compute + "\" }");
  };
  const std::string lone = "effects/probe.lua:5: error: pass 'glow.lone' of effect 'probe': ";
  EXPECT_EQ(pass("lone", "plain"),
            lone + "'plain' is a pixel shader; allowed: a shader that defines vec4 compute_at(ivec2 pixel)");
  EXPECT_EQ(pass("lone", "other"),
            lone +
                "'lone' and 'other' declare different inputs or parameters (sampler2D depth; float "
                "more, sampler2D depth); allowed: sampler2D depth");
  EXPECT_EQ(
      pass("plain", "group"),
      "effects/probe.lua:5: error: pass 'glow.plain' of effect 'probe': compute is another way of a sample shader; "
      "'plain' is a pixel shader");
  EXPECT_EQ(pass("lone", "grup").substr(0, lone.size() + 21), lone + "unknown shader 'grup'");
}

TEST_F(BuildMessages, WrongValues) {
  EXPECT_EQ(gain(kRest + ", gain = \"much\""), kAt5 + "gain = \"much\" is not a number; allowed: a number");
  EXPECT_EQ(gain(kRest + ", gain = source"), kAt5 + "gain = an image is not a number; allowed: a number");
  EXPECT_EQ(gain(kRest + ", gain = { 1, 2 }"), kAt5 + "gain = {1, 2} is not a number; allowed: a number");
  EXPECT_EQ(gain(kRest + ", gain = 0/0"), kAt5 + "gain = -nan is not finite; allowed: a number");
  EXPECT_EQ(gain(kRest + ", gain = 1e39"), kAt5 + "gain = 1e+39 is not finite; allowed: a number");
  EXPECT_EQ(gain("gain = 1, high = source, steps = 1, on = true, tint = { 1, 2 }"),
            kAt5 + "tint = {1, 2} is of another length; allowed: { 3 numbers }");
  EXPECT_EQ(gain("gain = 1, high = source, steps = 1, on = true, tint = 1"),
            kAt5 + "tint = 1 is not an array of numbers; allowed: { 3 numbers }");
  EXPECT_EQ(gain("gain = 1, high = source, steps = 1.5, on = true, tint = { 1, 2, 3 }"),
            kAt5 + "steps = 1.5 is not an integer; allowed: an integer");
  EXPECT_EQ(gain("gain = 1, high = source, steps = 1, on = 1, tint = { 1, 2, 3 }"),
            kAt5 + "on = 1 is not a boolean; allowed: true, false");
  EXPECT_EQ(gain(kRest + ", gain = 1, taps = 0xdeadbeef"),
            kAt5 + "taps = 3735928559 is no integer of 32 bits; allowed: an integer");
  EXPECT_EQ(gain(kRest + ", gain = 1, taps = 2.5"), kAt5 + "taps = 2.5 is not an integer; allowed: an integer");
  EXPECT_EQ(gain("high = 5"), kAt5 + "high = 5 is not an image");
}

TEST_F(BuildMessages, Sizes) {
  EXPECT_EQ(gain(kRest + ", gain = 1, size = source"),
            kAt5 + "a pixel shader's target has the size of its source; leave out size");
  const auto lone = [&](const std::string& size) {
    return error("return g:pass { shader = \"lone\", depth = source,\n size = " + size + " }");
  };
  const std::string at = "effects/probe.lua:5: error: pass 'glow.lone' of effect 'probe': ";
  EXPECT_EQ(lone("{ 0, 4 }"), at + "size 0×4 is out of range; allowed: 1…16384 each way");
  EXPECT_EQ(lone("{ 4, -1 }"), at + "size 4×-1 is out of range; allowed: 1…16384 each way");
  EXPECT_EQ(lone("{ 16385, 1 }"), at + "size 16385×1 is out of range; allowed: 1…16384 each way");
  EXPECT_EQ(lone("nil"),
            "effects/probe.lua:4: error: pass 'glow.lone' of effect 'probe': no input is called 'source', so size must "
            "be given; allowed: an image, {width, height}");
  const std::string call = "effects/probe.lua:5: error: effect 'probe': g:pass: ";
  EXPECT_EQ(lone("{ 4.5, 4 }"),
            call + "size = {4.5, 4} is no size; allowed: an image, {width, height} in whole pixels");
  EXPECT_EQ(lone("{ 1/0, 4 }"),
            call + "size = {inf, 4} is no size; allowed: an image, {width, height} in whole pixels");
  EXPECT_EQ(
      lone("7"),
      call + "size = 7 is no size; allowed: an image, {width, height} in whole pixels; a uniform takes another name");
  EXPECT_EQ(error("local half = g:filter { source = source, size = { 32, 16 }, filter = {} }\n"
                  "return g:pass { shader = \"gain\", source = source, gain = 1,\n tint = { 1, 1, 1 }, steps = 1, on = "
                  "true,\n high = half }"),
            "effects/probe.lua:7: error: pass 'glow.gain' of effect 'probe': 'high' is 32×16, but is read pixel by "
            "pixel with a target of 64×32; allowed: 64×32");
}

TEST_F(BuildMessages, Filters) {
  const auto filter = [&](const std::string& value) {
    return error("return g:filter { source = source, name = \"f\",\n filter = " + value + " }");
  };
  const std::string at = "effects/probe.lua:5: error: pass 'glow.f' of effect 'probe': the filter";
  EXPECT_EQ(filter("5"),
            "effects/probe.lua:5: error: pass 'glow.f' of effect 'probe': filter = 5 is not a filter; allowed: { "
            "interpolation, x, y, taps, edges }, fx.filters.…");
  EXPECT_EQ(filter("{ z = {} }"), at + " has no 'z'; allowed: edges, interpolation, taps, x, y");
  EXPECT_EQ(filter("{ interpolation = \"linaer\" }"),
            at + ": unknown interpolation \"linaer\"; allowed: nearest, linear, cubic_bspline; did you mean 'linear'?");
  EXPECT_EQ(filter("{ edges = \"miror\" }"),
            at + ": unknown edges \"miror\"; allowed: stretch, mirror; did you mean 'mirror'?");
  EXPECT_EQ(filter("{ x = 5 }"), at + ": x = 5 is not a list of taps; allowed: {{offset, weight}, …}");
  EXPECT_EQ(filter("{ x = {} }"), at + ": x has 0 taps, not 1…256; allowed: {{offset, weight}, …}");
  EXPECT_EQ(filter("{ y = { { 0, 1 }, { 1 } } }"), at + ": tap 2 of y is {1}; allowed: {{offset, weight}, …}");
  EXPECT_EQ(filter("{ y = { { 0, 0/0 } } }"), at + ": tap 1 of y is {0, -nan}; allowed: {{offset, weight}, …}");
  EXPECT_EQ(filter("{ taps = { { 0, 1 } } }"), at + ": tap 1 of taps is {0, 1}; allowed: {{dx, dy, weight}, …}");
  EXPECT_EQ(filter("{ taps = { { 0, 0, 1 } }, x = { { 0, 1 } } }"),
            at + " has taps and x or y; only one way at a time");
  EXPECT_EQ(filter("{ x = { { 1e6, 1 } } }"),
            at + ": tap 1 of x is {1000000, 1}, too far away; allowed: offsets of -16384 to 16384 texels");
  EXPECT_EQ(error("return g:filter { filter = {} }"),
            "effects/probe.lua:4: error: pass 'glow.filter' of effect 'probe': needs 'source', an image");
  EXPECT_EQ(error("return g:filter { source = 5, filter = {} }"),
            "effects/probe.lua:4: error: effect 'probe': g:filter: source = 5 is not an image");
  EXPECT_EQ(
      error("return g:filter { source = source, filter = {}, siez = 1 }"),
      "effects/probe.lua:4: error: effect 'probe': g:filter has no 'siez'; allowed: channels, filter, name, precise, "
      "size, source; "
      "did you mean 'size'?");
  EXPECT_EQ(error("local fx = require \"afterglow\"\nreturn fx.filters.gausian_vertical()"),
            "effects/probe.lua:5: error: unknown filter \"gausian_vertical\"; allowed: area, bilinear, box, bspline, "
            "gaussian_halving, "
            "gaussian_vertical, plus, tent; did you mean 'gaussian_vertical'?");
  EXPECT_EQ(error("local fx = require \"afterglow\"\nlocal f = fx.filters.box(0)"),
            "effects/probe.lua:5: error: fx.filters.box: delta = 0 is not a distance; allowed: 0 < delta ≤ 64 texels");
}

TEST_F(BuildMessages, Inputs) {
  EXPECT_EQ(error("g:input(\"depth\")"),
            "effects/probe.lua:4: error: effect 'probe' asks for the input 'depth', which its needs and optional do "
            "not name");
  EXPECT_EQ(error("g:input(\"dept\")", "\noptional = { \"depth\", \"normal\" },"),
            "effects/probe.lua:4: error: effect 'probe' asks for the input 'dept', which its needs and optional do not "
            "name; allowed: depth, normal; did you mean 'depth'?");
  EXPECT_EQ(error("g:input(5)"), "effects/probe.lua:4: error: g:input: 5 is not the name of an input");
}

TEST_F(BuildMessages, TheGraphAndImages) {
  EXPECT_EQ(error("g.pass { shader = \"plain\" }"),
            "effects/probe.lua:4: error: the first argument is a table, not the graph; allowed: g:pass { … }");
  EXPECT_EQ(error("g:pas {}"),
            "effects/probe.lua:4: error: the graph has no \"pas\"; allowed: cryptomatte, filter, fps, frame, "
            "frame_time, history, image, input, keep, length_scale, lookup, ocio, pass, preview_scale, skip, time; did "
            "you mean 'pass'?");
  EXPECT_EQ(error("local w = source.widht"),
            "effects/probe.lua:4: error: an image has no \"widht\"; allowed: width, height; did you mean 'width'?");
  EXPECT_EQ(error("source.width = 5"), "effects/probe.lua:4: error: an image cannot be changed: width = 5");
  EXPECT_EQ(error("g.frame = 5"), "effects/probe.lua:4: error: the graph cannot be changed: frame = 5");
  EXPECT_EQ(error("return g:pass(5)"),
            "effects/probe.lua:4: error: effect 'probe': g:pass takes a table, not 5; allowed: g:pass { … }");
  EXPECT_EQ(error("return g:pass { shader = \"plain\", source = source,\n name = \"a b\" }"),
            "effects/probe.lua:5: error: pass 'glow.plain' of effect 'probe': 'a b' cannot be the name of a pass; "
            "allowed: 1 to 64 letters, digits, '_', '-', '[' and ']'");
  EXPECT_EQ(error("g:skip()"), "effects/probe.lua:4: error: g:skip: nil is not a reason; allowed: a text");
  EXPECT_EQ(error("g:skip(\"why\") return g:pass { shader = \"plain\", source = source }"),
            "effects/probe.lua:3: error: build of effect 'probe' called g:skip, but did not return its source");
}

TEST_F(BuildMessages, Histories) {
  const std::string at = "effects/probe.lua:4: error: history 'glow.old' of effect 'probe': ";
  const std::string old = "local h = g:history { name = \"old\", size = source } ";
  EXPECT_EQ(error(old + "return source"),
            "effects/probe.lua:4: error: history 'glow.old' of effect 'probe' is given nothing to keep for the next "
            "frame; allowed: g:keep(history, image)");
  EXPECT_EQ(error("g:history { name = \"old\" }"),
            at + "its size is not known; allowed: size = an image, {width, height}; first = an image");
  EXPECT_EQ(
      error("g:history { name = \"old\", size = source,\n first = \"black\" }"),
      "effects/probe.lua:5: error: history 'glow.old' of effect 'probe': first = \"black\" is neither an image nor "
      "numbers; allowed: an image, a number, 1 to 4 numbers");
  EXPECT_EQ(error("g:history { name = \"old\", size = source,\n pre_roll = -1 }"),
            "effects/probe.lua:5: error: history 'glow.old' of effect 'probe': pre_roll = -1 is no number of frames; "
            "allowed: integer 0…10000");
  EXPECT_THAT(error("g:history { name = \"old\", size = source, pre_roll = 1e9 }"),
              HasSubstr("pre_roll = 1000000000 is no number of frames; allowed: integer 0…10000"));
  EXPECT_THAT(error("g:history { name = \"old\", size = source, frist = 1 }"),
              HasSubstr("history 'glow.old' of effect 'probe' has no 'frist'; allowed: channels, first"));
  EXPECT_EQ(error("g:history { name = \"old\", size = { 4, 4 },\n first = source }"),
            "effects/probe.lua:5: error: history 'glow.old' of effect 'probe': 'first' is 64×32, the history 4×4; "
            "allowed: 4×4");
  EXPECT_EQ(error("g:history { size = source, frist = 1 }"),
            "effects/probe.lua:4: error: effect 'probe': g:history has no 'frist'; allowed: channels, first, name, "
            "pre_roll, precise, size; did you mean 'first'?");
  EXPECT_EQ(error("g:history { name = \"old\", size = source,\n channels = 3 }"),
            "effects/probe.lua:5: error: history 'glow.old' of effect 'probe': channels = 3 is no number of channels; "
            "allowed: 1, 2, 4");
  EXPECT_EQ(error("g:history { name = \"old\", channels = 2,\n first = source }"),
            "effects/probe.lua:5: error: history 'glow.old' of effect 'probe': 'first' is an image, which is for "
            "histories of four channels; allowed: numbers");
  EXPECT_EQ(error("local h = g:history { name = \"old\", size = source, channels = 2 } "
                  "g:keep(h, g:pass { shader = \"plain\", source = source })"),
            at + "it has 2 channels, but is to keep an image of 4; allowed: channels = 2 of what makes the image");
  EXPECT_EQ(error("g:keep(source, source)"),
            "effects/probe.lua:4: error: effect 'probe': g:keep: the first image is no history of this effect; "
            "allowed: what g:history returned");
  EXPECT_EQ(error("g:keep(source, 5)"),
            "effects/probe.lua:4: error: effect 'probe': g:keep: 5 is not an image; allowed: g:keep(history, image)");
  EXPECT_EQ(error(old + "g:keep(h, source) g:keep(h, source)"), at + "g:keep was called for it before");
  EXPECT_EQ(error("local h = g:history { name = \"old\", size = { 4, 4 } } g:keep(h, source)"),
            at + "it is 4×4, but is to keep 64×32; allowed: 4×4");
}

TEST_F(BuildMessages, WhatBuildReturns) {
  EXPECT_EQ(error(""), "effects/probe.lua:3: error: build of effect 'probe' returned nil, not an image");
  EXPECT_EQ(error("return 5"), "effects/probe.lua:3: error: build of effect 'probe' returned 5, not an image");
}

TEST_F(BuildMessages, TooManyPasses) {
  EXPECT_EQ(error("for i = 1, 5000 do source = g:pass { shader = \"plain\", source = source } end"),
            "effects/probe.lua:4: error: pass 'glow.plain#4097' of effect 'probe': more than 4096 passes");
}

TEST_F(BuildMessages, ImagesAndGraphsOfAnotherRun) {
  scene.effect("keeper", R"(build = function(g, s, source)
    if rawget(_ENV, "KEPT") then return g:pass { shader = "plain", source = KEPT } end
    KEPT = source
    return source
  end,)");
  scene.effect("returner", R"(build = function(g, s, source)
    KEPT = rawget(_ENV, "KEPT") or source
    return KEPT
  end,)");
  scene.effect("hoarder", R"(build = function(g, s, source)
    GRAPH = rawget(_ENV, "GRAPH") or g
    return GRAPH:pass { shader = "plain", source = source }
  end,)");
  const auto second = [&](const std::string& name) {
    scene.stack("fx." + name + " {}");
    auto preset = scene.load();
    EXPECT_TRUE(preset && scene.build(*preset));
    auto graph = scene.build(*preset);
    return graph ? "" : scene.shorten(graph.error().text());
  };
  EXPECT_EQ(second("keeper"),
            "effects/keeper.lua:4: error: pass 'keeper.plain' of effect 'keeper': 'source' is an image of another run "
            "of build\n"
            "  in effect 'keeper' of preset.lua:3");
  EXPECT_EQ(second("returner"),
            "effects/returner.lua:3: error: build of effect 'returner' returned an image of another run\n"
            "  in effect 'returner' of preset.lua:3");
  EXPECT_EQ(second("hoarder"),
            "effects/hoarder.lua:5: error: the graph can only be used while its build runs\n  in effect 'hoarder' of "
            "preset.lua:3");
}

TEST_F(BuildMessages, ErrorsInsideAShaderHaveTheShadersPlace) {
  const std::string text = error("return g:pass { shader = \"broken\", source = source }");
  EXPECT_EQ(text.substr(0, text.find(':')), "shaders/broken.glsl");
}

TEST_F(BuildMessages, AnErrorOfLevel0IsAboutThePreset) {
  scene.effect("probe", R"(settings = { a = fx.int { default = 1 }, b = fx.int { default = 1 } },
    build = function(g, s, source)
      if s.a > s.b then error("a = " .. s.a .. " is above b = " .. s.b, 0) end
      if s.b > 100 then error("too much of everything", 0) end
      return source
    end,)");
  scene.stack("fx.probe {\n  b = 2,\n  a = 3,\n}");
  EXPECT_EQ(scene.build_error(), "preset.lua:5: error: a = 3 is above b = 2");
  scene.stack("\nfx.probe {\n  b = 200\n}");
  EXPECT_EQ(scene.build_error(), "preset.lua:4: error: too much of everything");
}

}  // namespace
}  // namespace afterglow::test
