// SPDX-License-Identifier: MIT
// Look-up tables as g:lookup lays them out (see engine/image/lut_file.h): where the numbers are, and what to do with them. The reads stand in
// the shader itself, where the engine can choose how images are read.

const int kLutMatrix = 1, kLutTable1d = 2, kLutTable3d = 3, kLutRange = 4, kLutCdl = 5, kLutPower = 6, kLutTableHalf = 7;

/// Entry i of a one-dimensional table.
ivec2 lut_entry(int row, int i) { return ivec2(i & 255, row + (i >> 8)); }

/// Entry (r, g, b) of a cube.
ivec2 lut_entry(int row, int size, ivec3 i) { return ivec2(i.r + size * (i.b & 1), row + i.g + size * (i.b >> 1)); }

/// The two corners of the tetrahedron around `f` that lie between (0,0,0) and (1,1,1) of a cell, and the weights of all four: of
/// (0,0,0), `a`, `b`, (1,1,1). Six tetrahedra share the diagonal from black to white, so that greys meet no others.
vec4 lut_tetrahedron(vec3 f, out ivec3 a, out ivec3 b) {
  bool rg = f.r > f.g, gb = f.g > f.b, rb = f.r > f.b;
  float most = max(f.r, max(f.g, f.b)), least = min(f.r, min(f.g, f.b));
  float middle = max(min(f.r, f.g), min(max(f.r, f.g), f.b));
  a = rg ? (rb ? ivec3(1, 0, 0) : ivec3(0, 0, 1)) : (gb ? ivec3(0, 1, 0) : ivec3(0, 0, 1));
  ivec3 lowest = rg ? (gb ? ivec3(0, 0, 1) : ivec3(0, 1, 0)) : (rb ? ivec3(0, 0, 1) : ivec3(1, 0, 0));
  b = ivec3(1) - lowest;
  return vec4(1.0 - most, most - middle, middle - least, least);
}

/// The half floats on both sides of v as entries of a table by their bits, and how far v is from the first to the second. By v's own
/// bits: a compiler may take packHalf2x16 and unpackHalf2x16 behind each other for nothing.
void lut_half(float v, out int low, out int high, out float t) {
  const uint most = 0x7bffu;  // 65504
  uint bits = floatBitsToUint(clamp(v, -65504.0, 65504.0)), size = bits & 0x7fffffffu;
  float steps = min(uintBitsToFloat(size) * 16777216.0, 1024.0);  // subnormal halves are steps of 2^-24
  bool normal = size >= 0x38800000u;                              // 2^-14
  uint code = min(normal ? (size - 0x38000000u) >> 13 : uint(steps), most);
  t = normal ? float(size & 0x1fffu) / 8192.0 : steps - float(code);
  int sign_bit = int(bits >> 31) << 15;
  low = sign_bit | int(code);
  high = sign_bit | int(min(code + 1u, most));
}

/// ASC CDL: slope, offset, power, saturation with Rec.709's luma; `extra` is (saturation, 1 to hold to 0…1).
vec3 lut_cdl(vec3 c, vec3 slope, vec3 offset, vec3 power, vec2 extra) {
  const vec3 luma = vec3(0.2126, 0.7152, 0.0722);
  bool held = extra.y > 0.5;
  c = c * slope + offset;
  if (held) c = clamp(c, 0.0, 1.0);
  c = mix(c, pow(max(c, vec3(0.0)), power), greaterThan(c, vec3(0.0)));  // what is not held keeps its negatives
  float y = dot(c, luma);
  c = y + extra.x * (c - y);
  return held ? clamp(c, 0.0, 1.0) : c;
}

/// v^e; negatives: 0 cut off, 1 mirrored, 2 left as they are.
vec3 lut_power(vec3 c, vec3 e, float style) {
  vec3 raised = pow(abs(c), e);
  return mix(raised, style < 0.5 ? vec3(0.0) : style < 1.5 ? -raised : c, lessThan(c, vec3(0.0)));
}
