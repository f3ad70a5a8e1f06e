#include "shader/interface.h"

namespace afterglow {

int component_count(ParamType type) {
  switch (type) {
    case ParamType::float1:
      return 1;
    case ParamType::float2:
      return 2;
    case ParamType::float3:
      return 3;
    case ParamType::float4:
      return 4;
    case ParamType::int1:
      return 1;
    case ParamType::int2:
      return 2;
    case ParamType::bool1:
      return 1;
  }
  return 0;
}

const char* glsl_name(ParamType type) {
  switch (type) {
    case ParamType::float1:
      return "float";
    case ParamType::float2:
      return "vec2";
    case ParamType::float3:
      return "vec3";
    case ParamType::float4:
      return "vec4";
    case ParamType::int1:
      return "int";
    case ParamType::int2:
      return "ivec2";
    case ParamType::bool1:
      return "bool";
  }
  return "";
}

}  // namespace afterglow
