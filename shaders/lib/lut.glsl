// SPDX-License-Identifier: MIT
// Look-up tables as g:lookup lays them out (see engine/image/lut_file.h): where the numbers are, and what to do with them. The reads stand in
// the shader itself, where the engine can choose how images are read.

const int kLutMatrix = 1, kLutTable1d = 2, kLutTable3d = 3, kLutRange = 4, kLutCdl = 5, kLutPower = 6, kLutTableHalf = 7, kLutTable3dLinear = 8;

/// Entry i of a one-dimensional table.
ivec2 lut_entry(int row, int i) { return ivec2(i & 255, row + (i >> 8)); }

/// Entry (r, g, b) of a cube.
ivec2 lut_entry(int row, int size, ivec3 i) { return ivec2(i.r + (-(i.b & 1) & size), row + i.g + size * (i.b >> 1)); }

/// What is added to the place of entry (r, g, b) of a cube to get to (r, g, b + 1).
ivec2 lut_step_b(int size, int b) {
  int odd = -(b & 1);  // all bits, or none
  return ivec2(size - (odd & (2 * size)), odd & size);
}

/// The two corners of the tetrahedron around `f` that lie between (0,0,0) and (1,1,1) of a cell, as ways from the place of (0,0,0), and the
/// weights of all four: of (0,0,0), `a`, `b`, (1,1,1). Six tetrahedra share the diagonal from black to white, so that greys meet no others.
vec4 lut_tetrahedron(vec3 f, ivec2 step_b, out ivec2 a, out ivec2 b) {
  bool rg = f.r > f.g, gb = f.g > f.b, rb = f.r > f.b;
  float larger = max(f.r, f.g), smaller = min(f.r, f.g);
  float most = max(larger, f.b), least = min(smaller, f.b), middle = max(smaller, min(larger, f.b));
  bool red_most = rg && rb, green_most = !rg && gb, red_least = !rg && !rb, green_least = rg && !gb;
  a = ivec2(red_most ? 1 : green_most ? 0 : step_b.x, red_most ? 0 : green_most ? 1 : step_b.y);
  b = ivec2(red_least ? step_b.x : green_least ? 1 + step_b.x : 1, red_least ? 1 + step_b.y : green_least ? step_b.y : 1);
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
