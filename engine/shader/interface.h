// What a shader of an effect declares: its kind, inputs and parameters, found by scanning its text (no compiler
// needed).
//
// An author's shader file, e.g. shaders/glow/threshold.glsl:
//
//   #include "lib/color.glsl"                 // an include is a library: hoisted, included once, sees no macros of the
//   shader uniform float threshold;                  // dynamic parameter: bytes that may change per frame
//   layout(constant_id = 0) const bool fade = false;   // specialised parameter: compiled in
//   vec4 apply(vec4 color) { … }              // kind `pixel`
//
//   vec4 apply(vec4 color, vec4 high)         // `high`: a second input of the same size, read at its own pixel
//   vec4 apply(vec4 color, ivec2 pixel)       // an ivec2 at the end: where the pixel lies in the target
//
//   uniform sampler2D depth;                  // an input image that is read freely
//   vec4 sample_at(ivec2 pixel) { … }         // kind `sample`; `pixel` is the target's
//
// Exactly one of `apply` and `sample_at` must be defined.
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

#include <string>
#include <vector>

namespace afterglow {

enum class ShaderKind { pixel, sample };

/// Types of parameters: float, vec2, vec3, vec4, int, ivec2, bool. A bool or int constant may be specialised.
enum class ParamType { float1, float2, float3, float4, int1, int2, bool1 };

int component_count(ParamType type);
const char* glsl_name(ParamType type);

struct ShaderParam {
  std::string name;
  ParamType type = ParamType::float1;
  bool specialised = false;  ///< a `layout(constant_id = …) const`; else a dynamic `uniform`
  double default_value = 0;  ///< of specialised parameters; dynamic ones must be given
  int line = 0;
};

struct ShaderInput {
  std::string name;
  bool pixelwise = false;  ///< an argument of `apply` (same size, own pixel); else a sampler2D
  int line = 0;
};

struct ShaderInterface {
  ShaderKind kind = ShaderKind::pixel;
  bool at_pixel = false;  ///< `apply` takes the target's pixel as its last argument
  std::vector<ShaderInput>
      inputs;  ///< in order of declaration; for `apply` without its first argument (the colour that flows through)
  std::vector<ShaderParam> params;  ///< in order of declaration
};

}  // namespace afterglow
