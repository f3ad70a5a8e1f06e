// SPDX-License-Identifier: MIT
// What a shader of an effect declares: its kind, inputs and parameters, found by scanning its text (no compiler
// needed).
//
// An author's shader file, e.g. shaders/glow/threshold.glsl:
//
//   #include "lib/color.glsl"                 // a library: hoisted, included once, sees no macros of the shader
//   uniform float threshold;                  // dynamic parameter: bytes that may change per frame
//   layout(constant_id = 0) const bool fade = false;   // specialised parameter: compiled in
//   vec4 apply(vec4 color) { … }              // kind `pixel`
//
//   vec4 apply(vec4 color, vec4 high)         // `high`: a second input of the same size, read at its own pixel
//   vec4 apply(vec4 color, ivec2 pixel)       // an ivec2 at the end: where the pixel lies in the target
//
//   uniform sampler2D depth;                  // an input image that is read freely
//   vec4 sample_at(ivec2 pixel) { … }         // kind `sample`; `pixel` is the target's
//   bool done_at(ivec2 pixel, out vec4 color) { … }   // beside it: true where `color` is the result already
//
//   layout(local_size_x = 8, local_size_y = 8) in;   // invocations that work together, and may share variables
//   shared vec4 tile[64];                            // of a workgroup; begins as zeros
//   vec4 compute_at(ivec2 pixel) { … }        // kind `compute`; all invocations of a workgroup call it
//
// Exactly one of `apply`, `sample_at` and `compute_at` must be defined.
//
// What every shader can call besides GLSL 4.60 is in shaders/lib/prelude.glsl. An include with a folder
// ("lib/color.glsl") is looked up along the search path, a bare name ("helper.glsl") first beside the file that
// includes it; it is hoisted even from within #if.
//
// Shaders of different authors stand in one kernel, so every name of file scope is made unique by rewriting the text.
// That asks for plain text: no names that begin with ag_, no ##, no macros that make declarations or hold half a
// bracket, no #version, #extension, #pragma or #line, no functions named like GLSL's own, no `discard`. In return, a
// macro, a struct or a helper of one shader never reaches another.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

/// How a pass makes its image. `filter` is data, the others are authors' shaders.
enum class PassKind { pixel, sample, compute, filter };

/// What is the same for all passes of a kind: one row of a table in interface.cpp.
struct PassKindInfo {
  const char* name;       ///< in reports and messages
  const char* entry;      ///< the function that a shader of this kind defines; null: there is no shader
  const char* signature;  ///< the same as authors write it
  bool begins;            ///< it begins a kernel; else it continues what feeds it
};
const PassKindInfo& info_of(PassKind kind);
/// The kind whose shaders define this function, if there is one.
std::optional<PassKind> kind_of_entry(std::string_view function);
/// "apply, sample_at, compute_at", or their signatures.
std::string entry_names();
std::string entry_signatures();

/// Types of parameters: float, vec2, vec3, vec4, int, ivec2, bool, mat2, mat3, mat4. A bool or int constant may be
/// specialised; all but bool and matrices may be arrays.
enum class ParamType { float1, float2, float3, float4, int1, int2, bool1, matrix2, matrix3, matrix4 };

/// Elements that an array may have.
inline constexpr int kMostElements = 256;

/// Numbers of a value; of a matrix all of them.
int component_count(ParamType type);
/// Rows and columns of a matrix; 0 of the others.
int matrix_side(ParamType type);
/// Numbers that follow each other in a uniform block: of a vector, of a column of a matrix.
int vector_length(ParamType type);
const char* glsl_name(ParamType type);
/// Of a kernel's uniform block, at most.
int block_bytes(ParamType type, int elements);
/// What all parameters of a kernel may take: as much as every Vulkan device has room for.
inline constexpr int kMostParamBytes = 16384;
std::optional<ParamType> param_type_of(std::string_view glsl_name);
/// What a `uniform` may be of, for messages.
const std::vector<std::string>& uniform_types();

struct ShaderParam {
  std::string name;
  ParamType type = ParamType::float1;
  bool specialised = false;  ///< a `layout(constant_id = …) const`; else a dynamic `uniform`
  double default_value = 0;  ///< of specialised parameters; dynamic ones must be given
  int line = 0;
  int elements = 0;  ///< of an array; 0: it is none
};

struct ShaderInput {
  std::string name;
  bool pixelwise = false;  ///< an argument of `apply` (same size, own pixel); else a sampler2D
  int line = 0;
};

/// Of a compute shader. Both sizes are at most 1024 each way, `invocations` at most 1024 in all.
struct Workgroup {
  Size invocations{1, 1};
  /// The part of the target that one workgroup makes: its upper left invocations make one pixel each, the others none.
  Size pixels{1, 1};
};

struct ShaderInterface {
  PassKind kind = PassKind::pixel;
  bool at_pixel = false;  ///< `apply` takes the target's pixel as its last argument
  std::vector<ShaderInput>
      inputs;  ///< in order of declaration; for `apply` without its first argument (the colour that flows through)
  std::vector<ShaderParam> params;     ///< in order of declaration
  std::optional<Workgroup> workgroup;  ///< of a compute shader
  bool done = false;                   ///< a sample shader that defines kDoneFunction too
};

/// Keys of a script's `g:pass { … }` beside the inputs and parameters of its shader, which may have none of these
/// names.
const std::vector<std::string>& pass_keys();

/// What a sample shader may define beside its entry: where it is true, its colour is the pixel, and `sample_at` has
/// nothing to do.
inline constexpr std::string_view kDoneFunction = "done_at";
inline constexpr std::string_view kDoneSignature = "bool done_at(ivec2 pixel, out vec4 color)";

}  // namespace afterglow
