// SPDX-License-Identifier: MIT
// AgX (T. Sobotka, 2022) with Blender 4.0's matrices over Rec.2020 and B. Wrensch's looks: light of 10 stops below middle grey to 6.5 above,
// as a logarithm, through Sobotka's sigmoid; the matrix before it pulls saturated light towards white, so that bright light bleaches as on film.
layout(constant_id = 0) const int look = 0;  // 0 base, 1 punchy, 2 golden

const float kLowest = 0.18 / 1024.0;  // light that becomes 0
const float kPivot = 10.0 / 16.5;           // where middle grey is, of 16.5 stops; it becomes 0.5

/// Sobotka's equation_full_curve: slope 2 at the pivot, powers 3 below and 3.25 above, to 0 and 1 at the ends. Below it is
/// ½ − kToe·f(b), f(b) = b/(1 + b³)^⅓. Darks keep their digits: ½ is kToe·f(kEnd), and the difference of both is taken as that of their
/// cubes over f² + f·f(kEnd) + f(kEnd)², where kEnd − b is x·2/kToe.
vec3 agx_sigmoid(vec3 x) {
  const float kToe = 0.5122773822930714, kShoulder = 0.5414641562781497;
  const float kEnd = kPivot * 2.0 / kToe, kEndValue = 0.5 / kToe, kEndCube = 1.0 + kEnd * kEnd * kEnd;
  vec3 below = max(kPivot - x, 0.0) * (2.0 / kToe), above = max(x - kPivot, 0.0) * (2.0 / kShoulder);
  vec3 cube = 1.0 + below * below * below, value = below * pow(cube, vec3(-1.0 / 3.0));
  vec3 low = x * (2.0 / kEndCube) * (below * (below + kEnd) + kEnd * kEnd) / (cube * (value * (value + kEndValue) + kEndValue * kEndValue));
  vec3 high = 0.5 + kShoulder * above * pow(1.0 + pow(above, vec3(3.25)), vec3(-1.0 / 3.25));
  return mix(low, high, greaterThanEqual(x, vec3(kPivot)));
}

/// Slope, power and saturation of the encoded colour. The luma is that before slope and power, as in Wrensch's shader; an ASC CDL takes
/// the one behind them.
vec3 agx_look(vec3 c, vec3 slope, float power, float saturation) {
  float y = dot(c, vec3(0.2126, 0.7152, 0.0722));
  return y + saturation * (pow(c * slope, vec3(power)) - y);
}

vec4 apply(vec4 color) {
  vec3 c = clamp(color.rgb, 0.0, 65504.0);
  c = vec3(dot(c, vec3(0.5448147465, 0.3737873984, 0.0813978551)),  // Rec.709 to Rec.2020, then the inset
           dot(c, vec3(0.1404169485, 0.7541375546, 0.1054454970)),
           dot(c, vec3(0.0888104196, 0.1788717564, 0.7323178240)));
  c = agx_sigmoid(min(log2(max(c * (1.0 / kLowest), 1.0)) * (1.0 / 16.5), 1.0));
  if (look == 1) c = agx_look(c, vec3(1.0), 1.35, 1.4);
  if (look == 2) c = agx_look(c, vec3(1.0, 0.9, 0.5), 0.8, 0.8);
  c = max(vec3(dot(c, vec3(1.1271005818, -0.1106066431, -0.0164939387)),  // the outset
               dot(c, vec3(-0.1413297635, 1.1578237022, -0.0164939387)),
               dot(c, vec3(-0.1413297635, -0.1106066431, 1.2519364066))), 0.0);
  c = pow(c, vec3(2.2));
  c = vec3(dot(c, vec3(1.6604910021, -0.5876411388, -0.0728498633)),  // Rec.2020 to Rec.709
           dot(c, vec3(-0.1245504745, 1.1328998971, -0.0083494226)),
           dot(c, vec3(-0.0181507634, -0.1005788980, 1.1187296614)));
  return vec4(clamp(c, 0.0, 1.0), color.a);
}
