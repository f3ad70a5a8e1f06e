// SPDX-License-Identifier: MIT
#include "image/ocio_glsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/text.h"
#include "image/ocio_module.h"

namespace afterglow {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr std::size_t kMaxText = 256u << 10;  // bytes; more takes a compiler seconds
constexpr int kRow = 256;                     // entries a row of one-dimensional tables
constexpr int kMaxSide = 16384;

/// Texels for texels: an image that grows downwards.
class TableImage {
 public:
  int rows() const { return rows_; }
  void begin(int rows) {
    first_ = rows_;
    rows_ += rows;
    if (rows_ > kMaxSide) throw Unsupported{"needs tables that are larger than an image can be"};
  }
  void put(int x, int y, const float* rgb, int channels) {
    placed_.push_back({x, first_ + y, {rgb[0], rgb[channels > 1 ? 1 : 0], rgb[channels > 1 ? 2 : 0]}});
  }
  void finish(OcioShader& out) const {
    if (placed_.empty()) return;
    int width = 1;
    for (const auto& p : placed_) width = std::max(width, p.x + 1);
    out.size = {width, rows_};
    out.table.assign(static_cast<std::size_t>(out.size.area()) * 4, 0.0F);
    for (const auto& p : placed_) {
      auto* texel = out.table.data() + 4 * (static_cast<std::ptrdiff_t>(p.y) * width + p.x);
      for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(p.rgb[c])) throw Unsupported{"has a table with a number that is not finite"};
        texel[c] = p.rgb[c];
      }
      texel[3] = 1;
    }
  }

 private:
  struct Placed {
    int x, y;
    float rgb[3];
  };
  std::vector<Placed> placed_;
  int rows_ = 0, first_ = 0;
};

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

/// Its texture reads, by a function of ours that goes before it; its declaration goes.
void use_function(std::string& text, const std::string& sampler, const std::string& function) {
  for (const char* kind : {"sampler1D", "sampler2D", "sampler3D"})
    replace_all(text, fmt::format("uniform {} {};", kind, sampler), "");
  replace_all(text, fmt::format("texture({}, ", sampler), function + "(");
  if (text.find(sampler) != std::string::npos) throw Unsupported{"reads a table in a way that is not known here"};
}

// In rows of its own width, as the shader's positions count; in the image 256 a row.
std::string add_table_1d(const OCIO::GpuShaderDesc& desc, unsigned index, TableImage& image, std::string& text) {
  const char *name = nullptr, *sampler = nullptr;
  unsigned width = 0, height = 0;
  OCIO::GpuShaderDesc::TextureType channel{};
  OCIO::Interpolation interpolation{};
  desc.getTexture(index, name, sampler, width, height, channel, interpolation);
  const float* values = nullptr;
  desc.getTextureValues(index, values);
  const int count = static_cast<int>(width * height), channels = channel == desc.TEXTURE_RED_CHANNEL ? 1 : 3;
  const int row = image.rows();
  image.begin((count + kRow - 1) / kRow);
  for (int i = 0; i < count; ++i) image.put(i % kRow, i / kRow, values + std::ptrdiff_t(i) * channels, channels);
  const std::string function = std::string(name) + "_read";
  use_function(text, sampler, function);
  return fmt::format(R"(
vec4 {0}(vec2 at) {{
  float x = clamp(at.x * {1}.0 - 0.5, 0.0, {2}.0), base = floor(x);
  int begin = int(clamp(at.y * {3}.0, 0.0, {4}.0)) * {1}, low = begin + int(base), high = begin + min(int(base) + 1, {2});
  return fetch(table, ivec2(low & 255, {5} + (low >> 8))) * (1.0 - (x - base)) + fetch(table, ivec2(high & 255, {5} + (high >> 8))) * (x - base);
}}
vec4 {0}(float at) {{ return {0}(vec2(at, 0.5)); }}
)",
                     function, width, width - 1, height, height - 1, row);
}

// Positions are (b, g, r), as its textures are. Tetrahedra ask for texels, cubes for what lies between eight.
std::string add_table_3d(const OCIO::GpuShaderDesc& desc, unsigned index, TableImage& image, std::string& text) {
  const char *name = nullptr, *sampler = nullptr;
  unsigned edge = 0;
  OCIO::Interpolation interpolation{};
  desc.get3DTexture(index, name, sampler, edge, interpolation);
  const float* values = nullptr;
  desc.get3DTextureValues(index, values);
  const int n = static_cast<int>(edge), row = image.rows();
  image.begin(n * ((n + 1) / 2));
  for (int r = 0; r < n; ++r)
    for (int g = 0; g < n; ++g)
      for (int b = 0; b < n; ++b)
        image.put(b + n * (r & 1), g + n * (r >> 1), values + 3 * ((std::ptrdiff_t(r) * n + g) * n + b), 3);
  const std::string function = std::string(name) + "_read";
  use_function(text, sampler, function);
  const std::string texel = fmt::format(
      "\nvec4 {0}_texel(ivec3 i) {{ return fetch(table, ivec2(i.x + {1} * (i.z & 1), {2} + i.y + {1} * (i.z >> 1))); "
      "}}\n",
      name, n, row);
  if (interpolation == OCIO::INTERP_TETRAHEDRAL || interpolation == OCIO::INTERP_BEST)
    return texel + fmt::format("vec4 {0}(vec3 at) {{ return {1}_texel(ivec3(clamp(at * {2}.0, 0.0, {3}.0))); }}\n",
                               function, name, n, n - 1);
  return texel + fmt::format(R"(vec4 {0}(vec3 at) {{
  vec3 x = clamp(at * {2}.0 - 0.5, 0.0, {3}.0), base = floor(x), t = x - base;
  ivec3 i = ivec3(base), j = min(i + 1, ivec3({3}));
  vec4 near = ({1}_texel(i) * (1.0 - t.x) + {1}_texel(ivec3(j.x, i.yz)) * t.x) * (1.0 - t.y) +
              ({1}_texel(ivec3(i.x, j.y, i.z)) * (1.0 - t.x) + {1}_texel(ivec3(j.xy, i.z)) * t.x) * t.y;
  vec4 far = ({1}_texel(ivec3(i.xy, j.z)) * (1.0 - t.x) + {1}_texel(ivec3(j.x, i.y, j.z)) * t.x) * (1.0 - t.y) +
             ({1}_texel(ivec3(i.x, j.yz)) * (1.0 - t.x) + {1}_texel(j) * t.x) * t.y;
  return near * (1.0 - t.z) + far * t.z;
}}
)",
                             function, name, n, n - 1);
}

/// Arrays of constants at file scope become functions of their index: indexed arrays are copies in every thread. Floats
/// go into the table, integers (a few offsets, which compilers see through) into a chain of choices.
std::string move_arrays(TableImage& image, std::string& text) {
  std::string functions;
  for (std::size_t at = 0; (at = text.find("const ", at)) != std::string::npos;) {
    const std::size_t end = text.find(';', at), open = text.find('[', at), values = text.find("](", at);
    if (end == std::string::npos || values == std::string::npos || values > end || open > end) {
      at += 6;
      continue;
    }
    const std::vector<std::string> words = split(text.substr(at, open - at), ' ');
    if (words.size() != 3) throw Unsupported{"declares an array in a way that is not known here"};
    const std::string &type = words[1], &name = words[2];
    const auto numbers = split(text.substr(values + 2, text.rfind(')', end) - values - 2), ',');
    if (type == "int") {
      functions += fmt::format("\nint {}_at(int i) {{ return ", name);
      for (std::size_t i = 0; i + 1 < numbers.size(); ++i)
        functions += fmt::format("i == {} ? {} : ", i, trim(numbers[i]));
      functions += trim(numbers.back()) + "; }\n";
    } else {
      const int row = image.rows(), count = static_cast<int>(numbers.size());
      image.begin((count + kRow - 1) / kRow);
      for (int i = 0; i < count; ++i) {
        const float value = std::strtof(numbers[static_cast<std::size_t>(i)].c_str(), nullptr);
        image.put(i % kRow, i / kRow, &value, 1);
      }
      functions +=
          fmt::format("\nfloat {}_at(int i) {{ return fetch(table, ivec2(i & 255, {} + (i >> 8))).r; }}\n", name, row);
    }
    text.erase(at, end + 1 - at);
    for (std::size_t use = at; (use = text.find(name + "[", use)) != std::string::npos;) {
      const std::size_t bracket = use + name.size(), close = text.find(']', bracket);
      if (close == std::string::npos || text.find('[', bracket + 1) < close)
        throw Unsupported{"reads an array in a way that is not known here"};
      text.replace(close, 1, ")");
      text.replace(bracket, 1, "_at(");
    }
  }
  return functions;
}

/// Variables that get their value in branches have one before.
void give_values(std::string& text) {
  replace_all(text, "vec3 res;", "vec3 res = vec3(0.0);");
  replace_all(text, "float res,", "float res = 0.0,");
}

// What is too large for it stays finite: powers of 1e12 do.
constexpr const char* kApply = R"(
vec4 apply(vec4 color) {
  vec3 c = clamp(ocio_color(vec4(clamp(color.rgb, -1e12, 1e12), 0.0)).rgb, -kMaxLight, kMaxLight);
  return vec4(mix(c, vec3(0.0), not_finite(vec4(c, 0.0)).xyz), color.a);
}
)";

}  // namespace

OcioShader ocio_glsl(const OCIO::Processor& processor) {
  auto desc = OCIO::GpuShaderDesc::CreateShaderDesc();
  desc->setLanguage(OCIO::GPU_LANGUAGE_GLSL_4_0);
  desc->setFunctionName("ocio_color");
  desc->setResourcePrefix("ocio_");
  const auto flags = static_cast<OCIO::OptimizationFlags>(static_cast<unsigned long>(OCIO::OPTIMIZATION_LOSSLESS) |
                                                          OCIO::OPTIMIZATION_NO_DYNAMIC_PROPERTIES);
  processor.getOptimizedGPUProcessor(flags)->extractGpuShaderInfo(desc);
  if (desc->getNumUniforms() > 0) throw Unsupported{"has properties that are set while it runs"};
  std::string text = desc->getShaderText(), functions;
  if (text.size() > kMaxText)
    throw Unsupported{
        fmt::format("needs a shader of {} KiB; at most {} are possible", text.size() >> 10, kMaxText >> 10)};
  TableImage image;
  for (unsigned i = 0; i < desc->getNumTextures(); ++i) functions += add_table_1d(*desc, i, image, text);
  for (unsigned i = 0; i < desc->getNum3DTextures(); ++i) functions += add_table_3d(*desc, i, image, text);
  functions += move_arrays(image, text);
  give_values(text);
  OcioShader out;
  image.finish(out);
  out.text = "#include \"lib/color.glsl\"\n#include \"lib/finite.glsl\"\n";
  if (!out.table.empty()) out.text += "\nuniform sampler2D table;\n";
  out.text += functions + text + kApply;
  return out;
}

}  // namespace afterglow
