// Piecewise power curves (J. Hable, "Filmic Tonemapping with Piecewise Power Curves", 2017): a toe, a line, a shoulder. The numbers of the three
// are made by the effect; x is light over white.
uniform float inverse_white;
uniform vec2 joints;     // x where the toe ends, x where the shoulder begins
uniform vec2 toe;        // y at its end, power
uniform vec2 line;       // slope, y at x = 0
uniform vec4 shoulder;   // x and y of its end, height, power
uniform float scale;     // so that white is 1

vec4 apply(vec4 color) {
  vec3 x = clamp(color.rgb, 0.0, 65504.0) * inverse_white;
  vec3 low = toe.x * pow(x / max(joints.x, 1e-9), vec3(toe.y));
  vec3 middle = line.x * x + line.y;
  vec3 left = max(shoulder.x - x, 0.0) / (shoulder.x - joints.y);
  vec3 high = shoulder.y - shoulder.z * pow(left, vec3(shoulder.w));
  vec3 y = mix(mix(high, middle, lessThan(x, vec3(joints.y))), low, lessThan(x, vec3(joints.x)));
  return vec4(y * scale, color.a);
}
