// SPDX-License-Identifier: MIT
// Fuses an anchor and pixel stages into the text of one fragment shader. The text holds no image size, no file and no
// pass name, so that equal work has equal text, and one compiled kernel serves every level of a pyramid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "shader/axis.h"
#include "shader/cpu/interleave.h"
#include "shader/cpu/storage_reads.h"
#include "shader/filter_anchor.h"
#include "shader/give_values.h"
#include "shader/kernel.h"
#include "shader/kernel_texts.h"
#include "shader/prelude.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxImages = 16;  ///< what every Vulkan device can bind to one stage

/// Invocations of a workgroup where authors say nothing of workgroups.
constexpr Size kOwnGroups{16, 8};

constexpr std::string_view kHeader =
    "#version 460\n"
    "layout(push_constant) uniform ag_Push { ivec2 ag_target_size; ivec2 ag_source_size; };\n";

/// Rounds to half floats, to nearest even, so that the store is exact whatever rounding the device's attachments have.
/// A NaN stays one, whichever it is: adding to the bits of some would make numbers of them.
constexpr std::string_view kRoundToHalf = R"(
vec4 ag_round_to_half(vec4 v) {
  bvec4 nan = greaterThan(floatBitsToUint(v) & 0x7fffffffu, uvec4(0x7f800000u));
  v = clamp(v, -65504.0, 65504.0);
  uvec4 bits = floatBitsToUint(v);
  uvec4 normal = (bits + 0xfffu + ((bits >> 13u) & 1u)) & ~0x1fffu;   // 10 bits of mantissa stay
  vec4 tiny = roundEven(v * 16777216.0) * 5.9604644775390625e-8;      // below 2^-14 halves are multiples of 2^-24
  vec4 rounded = mix(uintBitsToFloat(normal), tiny, lessThan(abs(v), vec4(6.103515625e-5)));
  return mix(rounded, uintBitsToFloat(uvec4(0x7fc00000u)), nan);
}
)";

/// Of a kernel that watches. A NaN or an infinity stays in a sum, whatever a later stage makes of it: no branch, and no
/// look at it until the end. Drivers may take it that no number is a NaN (Vulkan without SignedZeroInfNanPreserve), and
/// reckon comparisons away: what is asked for are its bits.
std::string add_light(const std::string& color) { return fmt::format("  ag_light += {0}.r + {0}.g + {0}.b;\n", color); }

/// GLSL's word for a storage image.
const char* format_word(int channels, bool half) {
  if (channels == 1) return half ? "r16f" : "r32f";
  if (channels == 2) return half ? "rg16f" : "rg32f";
  return half ? "rgba16f" : "rgba32f";
}
const char* format_word(ImageRead read) {
  switch (read) {
    case ImageRead::storage_r32f:
    case ImageRead::storage_r16f:
      return format_word(1, read == ImageRead::storage_r16f);
    case ImageRead::storage_rg32f:
    case ImageRead::storage_rg16f:
      return format_word(2, read == ImageRead::storage_rg16f);
    default:
      return format_word(4, read == ImageRead::storage_rgba16f);
  }
}

constexpr const char* kLeastCover = "1.17549435e-38";  ///< an alpha below it is none, as kLeastAlpha of core/alpha.h

class Assembler {
 public:
  explicit Assembler(const KernelDesc& kernel) : kernel_(kernel) {}

  Result<AssembledKernel> run() {
    if (kernel_.filter && kernel_.sample)
      return Error{ErrorKind::other, "a kernel has one anchor stage: a filter or a sample"};
    if (kernel_.sample && kernel_.sample->shader) out_.workgroup = kernel_.sample->shader->interface.workgroup;
    authors_groups_ = out_.workgroup.has_value();
    const int most_rows = authors_groups_ ? 1 : kMaxRows;
    if (kernel_.config.rows < 1 || kernel_.config.rows > most_rows)
      return Error{ErrorKind::other,
                   fmt::format("an invocation makes 1 to {} rows, not {}", most_rows, kernel_.config.rows)};
    if (kernel_.config.dispatched && !authors_groups_)
      out_.workgroup = Workgroup{kOwnGroups, {kOwnGroups.width, kOwnGroups.height * kernel_.config.rows}};
    AFTERGLOW_CHECK(anchor());
    row_ += held_to(anchor_channels());
    if (watches()) row_ += "  float ag_light = 0.0;\n" + add_light("ag_color");
    keep(0);
    for (std::size_t i = 0; i < kernel_.stages.size(); ++i) AFTERGLOW_CHECK(pixel_stage(i));
    if (out_.images.size() > kMaxImages) {
      const KernelStage& last = kernel_.stages.empty() ? *kernel_.sample : kernel_.stages.back();
      return Error{ErrorKind::script,
                   fmt::format("pass '{}' reads {} images, with its source", last.label, out_.images.size()),
                   last.shader->path.string(), 0, fmt::format("at most {}", kMaxImages)};
    }
    out_.glsl += kHeader;
    out_.file_names = texts_.file_names();
    out_.unset = texts_.unset();
    if (!out_.unset.empty()) out_.glsl += give_value_header();
    if (kernel_.config.defeat_uniform_inlining)
      out_.glsl += "// uniforms are hidden\n";  // another kernel, with another hash
    if (kernel_.config.guard_loops) out_.glsl += "// loops are guarded\n";
    if (kernel_.target_channels != 4) out_.glsl += fmt::format("// {} channels are stored\n", kernel_.target_channels);
    out_.glsl += targets();
    if (!block_.empty()) out_.glsl += "layout(set = 0, binding = 0, std140) uniform ag_Block {\n" + block_ + "};\n";
    out_.glsl += images_;
    out_.glsl += "#line 1 1\n";
    out_.glsl += prelude_text();
    if (!readers_.empty()) out_.glsl += "#line 1 1\n" + readers_;
    out_.glsl += texts_.text() + "#line 1 0\n";
    if (kernel_.target == KernelTarget::float16) out_.glsl += kRoundToHalf;
    if (kernel_.target == KernelTarget::float16) {
      if (watches())
        row_ += "  if (any(greaterThan(abs(ag_color.rgb), vec3(65504.0)))) ag_light = uintBitsToFloat(0x7f800000u);\n";
      row_ += "  ag_color = ag_round_to_half(ag_color);\n";
    }
    if (kernel_.target == KernelTarget::unorm8)  // the nearest code: some devices find it with eight digits behind it
      row_ += "  ag_color = floor(clamp(ag_color, 0.0, 1.0) * 255.0 + 0.5) * (1.0 / 255.0);\n";
    if (watches()) row_ += "  bool ag_finite = (floatBitsToUint(ag_light) & 0x7f800000u) != 0x7f800000u;\n";
    if (kernel_.finite_check == FiniteCheck::flag)
      row_ += fmt::format("  ag_color.a {} float(ag_finite);\n", kernel_.target == KernelTarget::unorm8 ? "*=" : "=");
    if (kernel_.finite_check == FiniteCheck::propagate)
      row_ += "  ag_color = mix(vec4(uintBitsToFloat(0x7fc00000u)), ag_color, bvec4(ag_finite));\n";
    if (row_.empty()) {
      store("ag_color{0}");
    } else {
      out_.glsl += fmt::format("vec4 {}(vec4 ag_color, ivec2 ag_at{}) {{\n{}  return ag_color;\n}}\n", kRowFunction,
                               row_parameters_, row_);
      // A sample shader's pixels are not held within the target, so that all rows are as far apart.
      store(std::string(kRowFunction) +
            (kernel_.sample && kernel_.config.rows > 1 ? "(ag_color{0}, ag_pixel + ivec2(0, {0})"
                                                       : "(ag_color{0}, ag_pixel{0}") +
            row_arguments_ + ")");
    }
    out_.glsl += head_function_ + "void main() {\n" + pixels() + body_ + "}\n";
    out_.hash = hash_text(out_.glsl);
    return std::move(out_);
  }

 private:
  bool watches() const { return kernel_.finite_check != FiniteCheck::none; }

  /// The number of the colour that flows into a stage.
  int color_of(std::size_t stage) const { return kernel_.stages[stage].color.value_or(static_cast<int>(stage)); }

  /// Is this colour wanted by others than the stage right behind it?
  bool is_kept(std::size_t value) const {
    const auto is_it = [&](int other) { return other == static_cast<int>(value); };
    for (std::size_t i = 0; i < kernel_.stages.size(); ++i) {
      if (i != value && is_it(color_of(i))) return true;
      for (const auto& [name, of_input] : kernel_.stages[i].values)
        if (is_it(of_input)) return true;
    }
    return false;
  }
  void keep(std::size_t value) {
    if (is_kept(value)) row_ += fmt::format("  vec4 ag_value{} = ag_color;\n", value);
  }

  /// A pixel stage, with division and multiplication by alpha around each run of those that want straight colour.
  Result<void> pixel_stage(std::size_t i) {
    const auto flows_on = [&](std::size_t at) {  // from the stage before it alone
      return at < kernel_.stages.size() && color_of(at) == static_cast<int>(at) && !is_kept(at) &&
             kernel_.stages[at - 1].channels == 4;
    };
    const auto straight = [&](std::size_t at) { return kernel_.stages[at].straight; };
    const KernelStage& stage = kernel_.stages[i];
    if (color_of(i) == kOwnImage) {
      take_own_image(stage);
    } else if (color_of(i) != static_cast<int>(i)) {
      row_ += fmt::format("  ag_color = ag_value{};\n", color_of(i));
    }
    if (straight(i) && !(i > 0 && straight(i - 1) && flows_on(i))) divide();
    AFTERGLOW_CHECK(add_stage(stage, PassKind::pixel));
    if (stage.channels != 4 && !straight(i)) row_ += held_to(stage.channels);
    if (watches()) row_ += add_light("ag_color");
    if (straight(i) && !(i + 1 < kernel_.stages.size() && straight(i + 1) && flows_on(i + 1))) multiply();
    if (straight(i)) row_ += held_to(stage.channels);
    keep(i + 1);
    return {};
  }

  int anchor_channels() const {
    if (kernel_.sample) return kernel_.sample->channels;
    return kernel_.filter ? kernel_.filter_channels : 4;
  }

  /// Of a colour whose image has so many channels: the others as readers of that image find them.
  static std::string held_to(int channels) {
    return channels == 1   ? "  ag_color = vec4(ag_color.r, 0.0, 0.0, 1.0);\n"
           : channels == 2 ? "  ag_color = vec4(ag_color.rg, 0.0, 1.0);\n"
                           : "";
  }

  /// The colour of the next stage is an image's.
  void take_own_image(const KernelStage& stage) {
    row_ += fmt::format("  ag_color = {};\n", read_own_pixel(stage, "source"));
  }

  /// An image that is read at the target's pixel; the name of its colour in the row's function.
  std::string read_own_pixel(const KernelStage& stage, const std::string& input) {
    if (const auto again = stage.again.find(input); again != stage.again.end()) return own_reads_.at(again->second);
    const std::string variable = fmt::format("ag_image{}", out_.images.size());
    const ImageRead read = add_image(stage_count_, input, variable, true);
    const std::string name = "ag_in" + std::to_string(out_.images.size());
    own_reads_[{stage_count_, input}] = name;
    if (watches()) row_ += add_light(name);
    row_parameters_ += ", vec4 " + name;
    row_arguments_ += ", " + texel(read, variable, "ag_pixel{0}");
    return name;
  }

  /// From associated to straight colour. Held within finite numbers: no light is lost where alpha is tiny, and what is
  /// multiplied again stays finite where alpha is out of all bounds. As cover_of in shaders/lib/alpha.glsl.
  void divide() {
    row_ += fmt::format(
        "  float ag_alpha{0} = ag_color.a, ag_cover{0} = mix(1.0, min(ag_color.a, 65504.0), ag_color.a >= "
        "{1});\n"
        "  ag_color = vec4(clamp(ag_color.rgb / ag_cover{0}, -3.4028234e38, 3.4028234e38), ag_color.a);\n",
        ++divisions_, kLeastCover);
  }
  void multiply() { row_ += fmt::format("  ag_color = vec4(ag_color.rgb * ag_cover{0}, ag_alpha{0});\n", divisions_); }

  Result<void> anchor() {
    if (kernel_.sample) return add_stage(*kernel_.sample, authors_groups_ ? PassKind::compute : PassKind::sample);
    const ImageRead read = add_image(-1, "source", "ag_image0", true);
    out_.images.back().interpolated = kernel_.filter && kernel_.config.hardware_filter;
    images_ += fmt::format("#define ag_texel0(p) {}\n", texel(read, "ag_image0", "p"));
    if (!kernel_.filter) {
      every_row("vec4 ag_color{0} = ag_texel0(ag_pixel{0});");
    } else if (!kernel_.config.hardware_filter && shares_rows(*kernel_.filter, kernel_.ratio_y, kernel_.config.rows)) {
      AFTERGLOW_TRY(const std::string code,
                    filter_rows(*kernel_.filter, kernel_.ratio_x, kernel_.ratio_y, kernel_.config.rows));
      body_ += code;
    } else {
      AFTERGLOW_TRY(const std::string code,
                    filter_anchor(*kernel_.filter, kernel_.ratio_x, kernel_.ratio_y, kernel_.config.hardware_filter));
      head_function_ = fmt::format("vec4 {}(ivec2 ag_pixel) {{\n  vec4 ag_color;\n{}  return ag_color;\n}}\n",
                                   kFilterFunction, code);
      every_row(fmt::format("vec4 ag_color{{0}} = {}(ag_pixel{{0}});", kFilterFunction));
    }
    return {};
  }

  /// Declares what the kernel writes.
  std::string targets() const {
    std::string out;
    if (out_.workgroup) {
      const Size& size = out_.workgroup->invocations;
      return fmt::format(
          "layout(local_size_x = {}, local_size_y = {}) in;\n"
          "layout(set = 0, binding = {}, {}) uniform restrict writeonly image2D ag_target;\n",
          size.width, size.height, out_.images.size() + 1,
          kernel_.target == KernelTarget::unorm8
              ? "rgba8"
              : format_word(kernel_.target_channels, kernel_.target == KernelTarget::float16));
    }
    for (int row = 0; row < kernel_.config.rows; ++row)
      out += fmt::format("layout(location = {0}) out vec4 ag_result{0};\n", row);
    return out;
  }

  /// The result of each row; {0} in `value` is its number.
  void store(const std::string& value) {
    if (!out_.workgroup) return every_row("ag_result{0} = " + value + ";");
    const char* where = authors_groups_            ? "if (ag_makes) "
                        : kernel_.config.rows == 1 ? ""
                                                   : "if (ag_pixel.y + {0} < ag_target_size.y) ";
    every_row(where + ("imageStore(ag_target, ag_pixel{0}, " + value + ");"));
  }

  /// Of a compute shader: the pixel of the invocation, whether it is one of the target's that the workgroup makes, and
  /// zeros for what the workgroup shares.
  std::string invocation() const {
    const Size& pixels = out_.workgroup->pixels;
    const std::string shared = texts_.zeros_of_shared(out_.workgroup->invocations.area());
    return fmt::format(
        "{0}  ivec2 ag_local = ivec2(gl_LocalInvocationID.xy), ag_last = ivec2({1}, {2});\n"
        "  ivec2 ag_pixel0 = ivec2(gl_WorkGroupID.xy) * (ag_last + 1) + min(ag_local, ag_last);\n"
        "  bool ag_makes = all(lessThanEqual(ag_local, ag_last)) && all(lessThan(ag_pixel0, ag_target_size));\n",
        shared.empty() ? "" : shared + "  barrier();\n", pixels.width - 1, pixels.height - 1);
  }

  /// Declares the pixels of the invocation. Those below the target's last row are made like it, and land in padding or
  /// nowhere.
  std::string pixels() const {
    if (authors_groups_) return invocation();
    const bool one = kernel_.config.rows == 1;
    const std::string first = one ? "ag_pixel0" : "ag_pixel";
    std::string place = "ivec2(gl_FragCoord.xy)", leave;
    if (out_.workgroup) {
      place = fmt::format("(ivec2(gl_WorkGroupID.xy) * ivec2({}, {}) + ivec2(gl_LocalInvocationID.xy))",
                          kOwnGroups.width, kOwnGroups.height);
      // Nobody waits for those beside the target.
      leave = fmt::format("  if (any(greaterThanEqual({}, ag_target_size))) return;\n", first);
    }
    if (one) return "  ivec2 ag_pixel0 = " + place + ";\n" + leave;
    std::string out = fmt::format("  ivec2 ag_pixel = {} * ivec2(1, {});\n{}", place, kernel_.config.rows, leave);
    for (int row = 0; row < kernel_.config.rows; ++row)
      out +=
          fmt::format("  ivec2 ag_pixel{0} = ivec2(ag_pixel.x, min(ag_pixel.y + {0}, ag_target_size.y - 1));\n", row);
    return out;
  }

  /// Adds a statement to main() for each row; {0} is its number.
  void every_row(const std::string& statement) {
    for (int row = 0; row < kernel_.config.rows; ++row)
      body_ += "  " + fmt::format(fmt::runtime(statement), row) + "\n";
  }

  /// `by_engine`: all reads of it go through the engine's functions, so that it can be a storage image.
  ImageRead add_image(int stage, const std::string& name, const std::string& variable, bool by_engine) {
    const std::size_t slot = out_.images.size();
    const ImageRead read = by_engine && slot < kernel_.reads.size() ? kernel_.reads[slot] : ImageRead::sampled;
    out_.images.push_back({stage, name, read});
    if (read == ImageRead::sampled) {
      images_ += fmt::format("layout(set = 0, binding = {}) uniform sampler2D {};\n", slot + 1, variable);
    } else {
      images_ += fmt::format("layout(set = 0, binding = {}, {}) uniform readonly image2D {};\n", slot + 1,
                             format_word(read), variable);
    }
    return read;
  }

  static std::string texel(ImageRead read, const std::string& variable, const std::string& pixel) {
    return read == ImageRead::sampled ? fmt::format("texelFetch({}, {}, 0)", variable, pixel)
                                      : fmt::format("imageLoad({}, {})", variable, pixel);
  }

  Result<void> add_stage(const KernelStage& stage, PassKind kind) {
    if (!stage.shader) return Error{ErrorKind::other, fmt::format("stage '{}' of a kernel has no shader", stage.label)};
    const ShaderSource& source = *stage.shader;
    if (source.interface.kind != kind)
      return shader_error(
          source.path.string(), 0,
          fmt::format("'{}' is a {} shader and cannot stand here", source.name, info_of(source.interface.kind).name));
    const ShaderScan& scanned = source.file->scan;
    const std::string prefix = fmt::format("ag_s{}_", stage_count_);
    AFTERGLOW_TRY(const auto values, constants(stage, prefix));
    StorageReaders readers;
    std::string arguments;  // behind the colour
    for (const auto& input : source.interface.inputs) {
      if (const auto value = stage.values.find(input.name); value != stage.values.end()) {
        arguments += fmt::format(", ag_value{}", value->second);
      } else if (input.pixelwise) {
        arguments += ", " + read_own_pixel(stage, input.name);
      } else {
        const std::string variable = prefix + input.name;
        const ImageRead read =
            add_image(stage_count_, input.name, variable, read_by_prelude_alone(scanned.tokens, input.name));
        if (read == ImageRead::sampled) continue;
        const std::string reader = fmt::format("ag_r{}_", out_.images.size());
        readers_ += storage_reads(reader, variable);
        readers[input.name] = reader;
      }
    }
    if (source.interface.at_pixel) arguments += ", ag_at";
    for (const auto& param : source.interface.params) {
      if (param.specialised) continue;
      const std::string array = param.elements > 0 ? fmt::format("[{}]", param.elements) : "";
      block_ += fmt::format("  {} {}{}{};\n", glsl_name(param.type), prefix, param.name, array);
      out_.params.push_back({stage_count_, param.name, param.type, 0, param.elements});
    }
    texts_.add(source, prefix, values, readers);
    if (!scanned.shared.empty() && !waits(source))
      out_.warnings.push_back(
          fmt::format("{}:{}: '{}' is shared, and no barrier() stands between writing and reading: what others write "
                      "may be missing",
                      source.path.string(), scanned.shared.front().line, scanned.shared.front().name));
    const std::string function = prefix + info_of(kind).entry;
    if (source.interface.done)
      sample_rest(prefix + std::string(kDoneFunction), function, source.keeps_state);
    else if (info_of(kind).begins && kernel_.config.rows > 1)
      begin_rows(function);
    else if (info_of(kind).begins)
      every_row("vec4 ag_color{0} = " + function + "(ag_pixel{0});");
    else
      row_ += apply(stage, function, arguments);
    ++stage_count_;
    return {};
  }

  static bool waits(const ShaderSource& source) {
    const auto has_barrier = [](const ShaderFile& file) {
      return std::ranges::find(file.scan.tokens, "barrier", &Token::text) != file.scan.tokens.end();
    };
    return has_barrier(*source.file) ||
           std::ranges::any_of(source.includes, [&](const auto& include) { return has_barrier(*include.file); });
  }

  /// A pixel stage's colour. Where nothing covers the pixel, only what the stage makes of light that is there all the
  /// same: as math.md §19 has it, and never less than black.
  std::string apply(const KernelStage& stage, const std::string& function, const std::string& arguments) const {
    std::string out = fmt::format("  ag_color = {}(ag_color{});\n", function, arguments);
    if (!stage.straight || !stage.lights_black) return out;
    return out + fmt::format(
                     "  ag_color.rgb = mix(ag_color.rgb, max(ag_color.rgb - {0}(vec4(vec3(0.0), ag_alpha{2}){1}).rgb, "
                     "min(ag_color.rgb, 0.0)), bvec3(ag_alpha{2} < {3}));\n",
                     function, arguments, divisions_, kLeastCover);
  }

  /// Each row's colour by a sample shader, within what is done to a row, so that rows take turns and share their reads.
  void begin_rows(const std::string& entry) {
    every_row("vec4 ag_color{0} = vec4(0.0);");
    row_ += fmt::format("  ag_color = {}(ag_at);\n", entry);
  }

  /// The colour of a pixel that may be done without the shader's entry. `keeps_state`: what is asked first may leave
  /// something in a variable for the entry, which a draw of its own would not find.
  void sample_rest(const std::string& done, const std::string& entry, bool keeps_state) {
    out_.two_draws = kernel_.config.two_draws && kernel_.config.rows == 1 && !out_.workgroup && !keeps_state;
    every_row("vec4 ag_color{0} = vec4(0.0);");
    if (!out_.two_draws) {
      every_row("if (!" + done + "(ag_pixel{0}, ag_color{0})) ag_color{0} = " + entry + "(ag_pixel{0});");
      return;
    }
    images_ += fmt::format("layout(constant_id = {}) const int ag_draw = {};\n", kDrawConstant,
                           static_cast<int>(KernelDraw::all));
    body_ += fmt::format(
        "  bool ag_done = ag_draw != {1} && {2}(ag_pixel0, ag_color0);\n"
        "  if (ag_draw == {0}) gl_FragDepth = ag_done ? 0.0 : 1.0;\n"
        "  if (ag_draw != {0} && !ag_done) ag_color0 = {3}(ag_pixel0);\n",
        static_cast<int>(KernelDraw::done), static_cast<int>(KernelDraw::rest), done, entry);
  }

  /// What replaces the declaration of each specialised parameter.
  static Result<std::vector<std::string>> constants(const KernelStage& stage, const std::string& prefix) {
    const ShaderSource& source = *stage.shader;
    std::vector<std::string> out;
    for (const auto& param : source.interface.params) {
      std::string text;
      if (param.specialised) {
        const auto given = stage.constants.find(param.name);
        const double value = given == stage.constants.end() ? param.default_value : given->second;
        const bool fits = std::isfinite(value) && (param.type != ParamType::int1 || std::abs(value) <= 2147483647.0);
        if (!fits)
          return shader_error(source.path.string(), param.line,
                              fmt::format("constant '{}' cannot be {}", param.name, value));
        std::string number = float_literal(value);
        if (param.type == ParamType::int1) number = fmt::format("{}", static_cast<int>(std::lround(value)));
        if (param.type == ParamType::bool1) number = value != 0 ? "true" : "false";
        text = fmt::format("const {} {}{} = {};", glsl_name(param.type), prefix, param.name, number);
      }
      out.push_back(std::move(text));
    }
    return out;
  }

  const KernelDesc& kernel_;
  AssembledKernel out_;
  bool authors_groups_ = false;  ///< the anchor is a shader of workgroups
  KernelTexts texts_;
  std::string block_, images_, readers_;
  std::string head_function_;                         ///< what finds one row's colour where rows share nothing
  std::string row_, row_parameters_, row_arguments_;  ///< what is done to one row's colour
  std::string body_;                                  ///< of main()
  std::map<std::pair<int, std::string>, std::string> own_reads_;  ///< names of colours, by stage and input
  int stage_count_ = 0, divisions_ = 0;
};

}  // namespace

Result<AssembledKernel> assemble(const KernelDesc& kernel) { return Assembler(kernel).run(); }

}  // namespace afterglow
