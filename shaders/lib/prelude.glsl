// SPDX-License-Identifier: MIT
// What every shader of an effect can call. The engine puts this text into each kernel by itself: do not include it.
//
// Pixels and texels: (0, 0) is the upper left one, y grows downwards, the centre of texel i is at i + 1/2. Reads outside an
// image give the nearest texel of its edge. Names that begin with ag_ belong to the engine.

// Size of the image that is being made, in pixels.
ivec2 target_size() { return ag_target_size; }

// Where the centre of target pixel x lies between source texels: the texel `base` at or before it, and the way to the next
// texel as the fraction rest/(2 n_target). (x + 1/2) n_source/n_target - 1/2 is a fraction of whole numbers and stays one, so that
// nothing is rounded for sides up to 16384. (The quotient is guessed in floats, as integer division is slow on many devices; the
// guess is off by one at most.)
void ag_phase(int x, int n_source, int n_target, out int base, out int rest) {
  int divisor = 2 * n_target;
  int dividend = (2 * x + 1) * n_source + n_target;  // one divisor too much: never negative
  int quotient = int(float(dividend) / float(divisor));
  rest = dividend - quotient * divisor;
  bool below = rest < 0;
  quotient -= below ? 1 : 0;
  rest += below ? divisor : 0;
  bool above = rest >= divisor;
  quotient += above ? 1 : 0;
  rest -= above ? divisor : 0;
  base = quotient - 1;
}

// That fraction as f, and g = 1 - f, both correctly rounded: the one near 0 keeps its digits.
void ag_fraction(int rest, int n_target, out float f, out float g) {
  int divisor = 2 * n_target;
  f = float(rest) / float(divisor);
  g = float(divisor - rest) / float(divisor);
}

// The same for a point that lies high + low texels further (high a multiple of 1/256, low below 1/256), which may be beyond the next
// texel: then base grows.
void ag_fraction_beyond(inout int base, int rest, int n_target, float high, float low, out float f, out float g) {
  float divisor = float(2 * n_target);
  float whole = float(rest) + high * divisor;  // exact: 16 bits before the point, 8 behind
  float part = low * divisor;
  bool beyond = (whole - divisor) + part >= 0.0;
  base += beyond ? 1 : 0;
  whole -= beyond ? divisor : 0.0;
  f = (whole + part) / divisor;
  g = ((divisor - whole) - part) / divisor;
}

// The texel that lies at i where the image is mirrored at its edges, again and again. (The quotient is guessed in floats and off by
// one at most.)
int ag_mirrored(int i, int last) {
  int period = 2 * last + 2;
  i -= period * int(floor(float(i) * (1.0 / float(period))));
  i += i < 0 ? period : 0;
  i -= i >= period ? period : 0;
  return min(i, period - 1 - i);
}

// The same for positions between texels, where a sampler interpolates: the picture on the other side of an edge is that on this side.
float ag_mirrored_at(float position, float size) {
  float period = 2.0 * size;
  position -= period * floor(position / period);
  return min(position, period - position);
}

// Size of an input, in texels.
ivec2 image_size(sampler2D image) { return textureSize(image, 0); }

vec4 ag_texel(sampler2D image, ivec2 pixel) { return texelFetch(image, pixel, 0); }

vec4 fetch_linear(sampler2D image, vec2 position);  // below

// GLSL's texture(image, at) and its kin become these: linear interpolation on every device, `at` from 0 to 1 over the image, reads
// outside give the edge. Within 1/512 of a texel's centre it is that texel, as texture units have it too: coordinates from 0
// to 1 are not exact. Images have one level.
vec4 ag_texture(sampler2D image, vec2 at) {
  vec2 position = at * vec2(image_size(image)), centre = floor(position) + 0.5;
  return fetch_linear(image, mix(position, centre, lessThan(abs(position - centre), vec2(1.0 / 512.0))));
}
vec4 ag_texture(sampler2D image, vec2 at, float level) { return ag_texture(image, at); }
vec4 ag_texture_offset(sampler2D image, vec2 at, ivec2 texels) {
  return ag_texture(image, at + vec2(texels) / vec2(image_size(image)));
}
// Whole numbers are no positions from 0 to 1: who calls these meant `fetch`, and is told (engine/shader/usable.cpp).
vec4 ag_texture(sampler2D image, ivec2 at) { return vec4(0.0); }
vec4 ag_texture(sampler2D image, ivec2 at, float level) { return vec4(0.0); }
vec4 ag_texture_offset(sampler2D image, ivec2 at, ivec2 texels) { return vec4(0.0); }

// GLSL's own, which some drivers get wrong where the number is a constant (Mesa 22.3 on CPUs).
vec2 ag_unpack_half(uint bits) { return vec2(unpackHalf2x16(bits).x, unpackHalf2x16(bits >> 16).x); }
uint ag_pack_snorm(vec4 v) {
  ivec4 bytes = ivec4(roundEven(clamp(v, -1.0, 1.0) * 127.0)) & 255;
  return uint(bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24);
}

// One texel, exactly as stored.
vec4 fetch(sampler2D image, ivec2 pixel) { return ag_texel(image, clamp(pixel, ivec2(0), image_size(image) - 1)); }

// The four texels around, weighted by f and g = 1 - f: exact where a texture unit would round f to 8 bits.
vec4 ag_bilinear(sampler2D image, ivec2 base, vec2 f, vec2 g) {
  ivec2 last = image_size(image) - 1;
  ivec2 a = clamp(base, ivec2(0), last);
  ivec2 b = clamp(base + 1, ivec2(0), last);
  vec4 upper = ag_texel(image, a) * g.x + ag_texel(image, ivec2(b.x, a.y)) * f.x;
  vec4 lower = ag_texel(image, ivec2(a.x, b.y)) * g.x + ag_texel(image, b) * f.x;
  return upper * g.y + lower * f.y;
}

// Linear interpolation at a position in texels of the image (the centre of texel i is at i + 1/2).
vec4 fetch_linear(sampler2D image, vec2 position) {
  vec2 size = vec2(image_size(image));
  vec2 t = clamp(position, vec2(0.0), size) - 0.5;  // reading outside is reading the edge, so this changes nothing else
  vec2 base = floor(t);
  vec2 f = t - base;
  return ag_bilinear(image, ivec2(base), f, 1.0 - f);
}

// Linear interpolation at the point of `image` that lies where the centre of target pixel `pixel` does when both images cover
// the same area, moved by a whole number of texels.
vec4 sample_scaled(sampler2D image, ivec2 pixel, ivec2 texel_offset) {
  ivec2 size = image_size(image);
  ivec2 base, rest;
  vec2 f, g;
  ag_phase(pixel.x, size.x, ag_target_size.x, base.x, rest.x);
  ag_phase(pixel.y, size.y, ag_target_size.y, base.y, rest.y);
  ag_fraction(rest.x, ag_target_size.x, f.x, g.x);
  ag_fraction(rest.y, ag_target_size.y, f.y, g.y);
  return ag_bilinear(image, base + texel_offset, f, g);
}
