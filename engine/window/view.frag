// SPDX-License-Identifier: MIT
// A picture as one looks at it: placed, filtered, exposed, compared, marked, encoded (view_pass.h says how).
#version 450

layout(set = 0, binding = 1) uniform sampler2D shown;
layout(set = 0, binding = 2) uniform sampler2D compared;
layout(set = 0, binding = 3) uniform sampler2D table;  // of a display (image/display_table.h); with kTable alone

// What is known when the pipeline is made: CPU drivers run through every branch that is left (view_pass.cpp has the same).
layout(constant_id = 0) const int kFlags = 0;
layout(constant_id = 1) const int kChannel = 0;          // ViewChannel
layout(constant_id = 2) const int kShownReads = 0;       // how each image is read
layout(constant_id = 3) const int kComparedReads = 0;
const int kFalseColor = 1, kDifference = 2, kEncode = 4, kGray = 8, kChecker = 16, kZoned = 64,
          kGamma = 128, kTable = 256;
const int kNearest = 0, kSmooth = 1, kMean = 2;

layout(push_constant) uniform Push {
  vec4 power;           // w: of kGamma
  vec4 below;           // mark of values under 0; w: gain of the exposure
  vec4 above;           // mark of values over 1
  vec4 not_finite;      // mark
  vec2 origin;          // of the picture, in pixels of the target
  float scale;          // pixels of the target for each of the picture
  float checker;        // side of a square of the checker board, in pixels of the target
  ivec2 picture;        // the size that `scale` is about
  ivec2 shown_size;
  ivec2 compared_size;
  int planes;           // of the table
  vec4 shaper;          // of it: bend, cells above and below 0, the plane of 0
} push;

layout(location = 0) out vec4 result;

const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
const float kTolerance = 1e-4;  // rounding may carry what a display can just show over its ends
const float kLargest = 1e30;
// As view_pass.h has them, sRGB-encoded; a test holds both together.
const int kFirstZone = -6, kLastZone = 6;
const vec3 kZones[13] = vec3[13](
    vec3(0.06, 0.06, 0.09), vec3(0.25, 0.10, 0.35), vec3(0.38, 0.20, 0.68), vec3(0.16, 0.33, 0.80), vec3(0.10, 0.52, 0.76),
    vec3(0.10, 0.58, 0.50), vec3(0.50, 0.50, 0.50), vec3(0.35, 0.68, 0.25), vec3(0.74, 0.80, 0.22), vec3(0.96, 0.76, 0.16),
    vec3(0.95, 0.50, 0.14), vec3(0.90, 0.20, 0.16), vec3(1.0, 1.0, 1.0));
const int kMarkBelow = 1, kMarkAbove = 2, kMarkNotFinite = 4;

bool has(int flag) { return (kFlags & flag) != 0; }

// By its bits: compilers may take isnan() for false.
bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

float tamed(float x) { return is_nan(x) ? 0.0 : clamp(x, -kLargest, kLargest); }
vec4 tamed(vec4 c) { return vec4(tamed(c.r), tamed(c.g), tamed(c.b), tamed(c.a)); }

int mark(float x) {
  if (!is_finite(x)) return kMarkNotFinite;
  if (x < -kTolerance) return kMarkBelow;
  return x > 1.0 + kTolerance ? kMarkAbove : 0;
}

// What of the pixel is looked at is out of range. Exposure moves the ends of the range, but not those of alpha.
int marks(vec4 c) {
  if (!has(kFalseColor) && !has(kZoned)) return 0;
  float gain = push.below.w;
  switch (kChannel) {
    case 0: return mark(c.r * gain) | mark(c.g * gain) | mark(c.b * gain);
    case 1: return mark(c.r * gain);
    case 2: return mark(c.g * gain);
    case 3: return mark(c.b * gain);
    case 4: return mark(c.a);
    default: return mark(dot(c.rgb, kLuminance) * gain);
  }
}

struct Sample {
  vec4 color;
  int marks;
};

// From the middle of a pixel to that of the next in a straight line. `at`: 0 is the middle of the first.
Sample between_pixels(sampler2D image, ivec2 last, vec2 at) {
  ivec2 low = ivec2(floor(at));
  vec2 part = at - vec2(low);
  Sample mean = Sample(vec4(0.0), 0);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec4 c = texelFetch(image, clamp(low + corner, ivec2(0), last), 0);
    vec2 near = mix(1.0 - part, part, vec2(corner));
    if (near.x * near.y > 0.0) mean.marks |= marks(c);
    mean.color += near.x * near.y * tamed(c);
  }
  return mean;
}

// The image pixels that lie under this pixel of the target: the nearest one when it is not smaller than that, else the mean
// of all it covers, each by the area that is covered. `at` is a point of the image, `reach` the side lengths of the target's
// pixel there; they are the same for all pixels, so that who makes the pipeline knows what `reads` is.
Sample sample_image(sampler2D image, int reads, ivec2 size, vec2 at, vec2 reach) {
  ivec2 last = size - 1;
  if (reads == kSmooth) return between_pixels(image, last, at - 0.5);
  if (reads == kNearest) {
    vec4 c = texelFetch(image, clamp(ivec2(floor(at)), ivec2(0), last), 0);
    return Sample(tamed(c), marks(c));
  }
  reach = max(reach, vec2(1.0));
  vec2 low = max(at - 0.5 * reach, vec2(0.0)), high = min(at + 0.5 * reach, vec2(size));
  ivec2 begin = clamp(ivec2(floor(low)), ivec2(0), last), end = clamp(ivec2(ceil(high)) - 1, begin, last);
  Sample mean = Sample(vec4(0.0), 0);
  float total = 0.0;
  for (int y = begin.y; y <= end.y; ++y) {
    float part = min(float(y + 1), high.y) - max(float(y), low.y);
    for (int x = begin.x; x <= end.x; ++x) {
      float weight = part * (min(float(x + 1), high.x) - max(float(x), low.x));
      vec4 c = texelFetch(image, ivec2(x, y), 0);
      if (weight > 0.0) mean.marks |= marks(c);
      mean.color += weight * tamed(c);
      total += weight;
    }
  }
  mean.color /= max(total, 1e-20);
  return mean;
}

vec3 with_channel(vec4 c) {
  switch (kChannel) {
    case 0: return c.rgb;
    case 1: return c.rrr;
    case 2: return c.ggg;
    case 3: return c.bbb;
    case 4: return c.aaa;
    default: return vec3(dot(c.rgb, kLuminance));
  }
}

vec3 over_background(vec4 c) {
  if (kChannel != 0 || !(has(kGray) || has(kChecker))) return with_channel(c);
  float background = 0.18;
  if (has(kChecker)) {
    ivec2 square = ivec2(floor(gl_FragCoord.xy / push.checker));
    background = ((square.x + square.y) & 1) == 0 ? 0.08 : 0.25;
  }
  return c.rgb + vec3(background * clamp(1.0 - c.a, 0.0, 1.0));
}

vec3 decoded(vec3 c) { return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045))); }

// How many stops a light lies from middle grey, to the nearest whole one.
vec3 zone_of(float light) {
  float stop = light > 0.0 ? floor(log2(light / 0.18) + 0.5) : float(kFirstZone);
  return decoded(kZones[int(clamp(stop, float(kFirstZone), float(kLastZone))) - kFirstZone]);
}

vec3 with_gamma(vec3 c) { return has(kGamma) ? sign(c) * pow(abs(c), vec3(push.power.w)) : c; }

// `as_light`: a display shows the colour as its table says. Marks, differences and alpha are no light.
vec3 looked_at(Sample s, out bool as_light) {
  as_light = false;
  if ((s.marks & kMarkNotFinite) != 0) return push.not_finite.rgb;
  vec4 c = s.color;
  c.rgb *= push.below.w;
  if (has(kZoned)) return zone_of(kChannel == 0 ? dot(c.rgb, kLuminance) : with_channel(c).r);
  if ((s.marks & kMarkBelow) != 0) return push.below.rgb;
  if ((s.marks & kMarkAbove) != 0) return push.above.rgb;
  c.rgb = with_gamma(c.rgb);
  as_light = has(kTable) && kChannel != 4;
  if (has(kFalseColor)) return kChannel == 0 ? vec3(dot(c.rgb, kLuminance)) : with_channel(c);  // marks stand out
  return over_background(c);
}

// sRGB codes. Its power as a polynomial of the fourth root, within 7e-6 (0.002 codes of 8 bits): CPU drivers take as long for pow()
// as for all else here. Minimax for 0.0031308…1 (IEC 61966-2-1).
vec3 encoded(vec3 c) {
  c = clamp(c, vec3(0.0), vec3(1.0));
  if (!has(kEncode)) return c;
  vec3 root = sqrt(sqrt(c));
  vec3 curve = vec3(-0.0681473692);
  curve = curve * root + 0.2895332135;
  curve = curve * root - 0.5774829909;
  curve = curve * root + 1.2554045638;
  curve = curve * root + 0.1620262245;
  curve = curve * root - 0.0613402120;
  return mix(curve, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

const int kTableTiles = 8;  // slices beside each other

vec3 table_at(ivec3 plane) {
  ivec2 tile = ivec2(plane.b % kTableTiles, plane.b / kTableTiles);
  return texelFetch(table, plane.rg + push.planes * tile, 0).rgb;
}

// Codes of the display between the planes of its table (DisplayTable has the formulas): tetrahedral.
vec3 displayed(vec3 light) {
  vec3 root = sqrt(sqrt(sqrt(min(abs(light), vec3(kLargest)))));
  vec3 bent = log2(1.0 + push.shaper.x * root * root * root);
  vec3 at = push.shaper.w + bent * mix(vec3(push.shaper.y), vec3(-push.shaper.z), lessThan(light, vec3(0.0)));
  at = clamp(at, vec3(0.0), vec3(float(push.planes - 1)));
  ivec3 low = min(ivec3(at), ivec3(push.planes - 2));
  vec3 part = at - vec3(low);
  float most = max(max(part.r, part.g), part.b), least = min(min(part.r, part.g), part.b);
  float middle = max(min(part.r, part.g), min(max(part.r, part.g), part.b));
  // Along the axis of the largest part, then of the middle one, then of the least.
  ivec3 first = part.r >= part.g && part.r >= part.b ? ivec3(1, 0, 0) : part.g >= part.b ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
  ivec3 last = part.b <= part.r && part.b <= part.g ? ivec3(0, 0, 1) : part.g <= part.r ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
  vec3 c = (1.0 - most) * table_at(low) + (most - middle) * table_at(low + first) +
           (middle - least) * table_at(low + 1 - last) + least * table_at(low + 1);
  c = clamp(c, vec3(0.0), vec3(1.0));
  return has(kEncode) ? c : decoded(c);
}

// `point`: of the picture, whatever the size of the image.
Sample sample_shown(vec2 point) {
  vec2 per_point = vec2(push.shown_size) / vec2(push.picture);
  return sample_image(shown, kShownReads, push.shown_size, point * per_point, per_point / push.scale);
}

Sample sample_compared(vec2 point) {
  vec2 per_point = vec2(push.compared_size) / vec2(push.picture);
  return sample_image(compared, kComparedReads, push.compared_size, point * per_point, per_point / push.scale);
}

void main() {
  vec2 point = (gl_FragCoord.xy - push.origin) / push.scale;
  Sample s = sample_shown(point);
  if (has(kDifference)) {
    Sample other = sample_compared(point);
    s = Sample(vec4(abs(s.color.rgb - other.color.rgb), 1.0), s.marks | other.marks);
  }
  bool as_light;
  vec3 color = looked_at(s, as_light);
  result = vec4(as_light && !has(kDifference) ? displayed(color) : encoded(color), 1.0);
}
