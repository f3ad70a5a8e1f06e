// SPDX-License-Identifier: MIT
// The fitted ACES transform (Unity core render pipeline, ACES.hlsl: AcesTonemap(unity_to_ACES(x)); after the Academy's RRT and sRGB ODT
// with their curves replaced by one rational function per channel, S. Hill and K. Narkowicz).
//
// Written as the published steps, but with what is algebraically one thing merged: constant matrices multiplied out, angles replaced by
// the tangent of the half angle, xyY left out. The differences to the published form are rounding only, below 3e-6 relative; tests
// compare with a double-precision implementation of the published steps.

/// 1 − |2·hue/135°| for tan(hue/2) = t in 0…tan(33.75°), where it falls to 0. |hue| = 2·atan(t); atan by a Chebyshev fit in t², error 9e-8.
float aces_red_ramp(float t) {
  float z = t * t;
  return 1.0 - t * (1.69765254 + z * (-0.565854464 + z * (0.338731144 + z * (-0.234443773 + z * (0.149787418 - z * 0.0575258119)))));
}

/// Scene-linear Rec.709, 0 ≤ x ≤ 60, to display-linear Rec.709 before clamping: about −0.03 … 1.18.
vec3 aces_tone_curve(vec3 x) {
  const float kRampEnd = 0.6681786379192989;  // tan(67.5°/2): from there on a colour counts as not red

  vec3 a = vec3(dot(x, vec3(0.4397010, 0.3829780, 0.1773350)),  // to ACES2065-1 (AP0)
                dot(x, vec3(0.0897923, 0.8134230, 0.0967616)),
                dot(x, vec3(0.0175440, 0.1115440, 0.8707040)));
  float low = min(a.r, min(a.g, a.b)), high = max(a.r, max(a.g, a.b));
  float saturation = (max(high, 1e-4) - max(low, 1e-4)) / max(high, 1e-2);
  float rg = a.r - a.g, gb = a.g - a.b, rb = a.r - a.b;
  float chroma = sqrt(max(rg * rb + gb * gb, 0.0));  // √(b(b−g) + g(g−r) + r(r−b))
  float sum = a.r + a.g + a.b;

  // Glow: dark saturated colours are raised by up to 5 %. The published sigmoid of (saturation − 0.4)/0.2 is ½(1 + h(2 − |h|)) with
  // h = 2.5·saturation − 1 held to ±1; its three cases of the luma sum + 1.75·chroma are one clamp.
  float h = min(2.5 * saturation - 1.0, 1.0);
  float gain = 0.025 + 0.025 * h * (2.0 - abs(h));
  float glow = 1.0 + gain * clamp(0.24 / max(sum + 1.75 * chroma, 1e-6) - 0.5, 0.0, 1.0);

  // Red modifier: saturated reds are darkened. hue = atan2(√3(g − b), 2r − g − b), whose radius is 2·chroma.
  float along_red = rg + rb;
  float t = along_red > 0.0 ? min(1.7320508075688772 * abs(gb) / max(2.0 * chroma + along_red, 1e-20), kRampEnd) : kRampEnd;
  float ramp = max(aces_red_ramp(t), 0.0);
  float smooth_ramp = ramp * ramp * (3.0 - 2.0 * ramp);
  a *= glow;
  a.r += smooth_ramp * smooth_ramp * saturation * 0.18 * (0.03 - a.r);

  vec3 c = max(vec3(dot(a, vec3(1.4514393161, -0.2365107469, -0.2149285693)),  // to ACEScg (AP1)
                    dot(a, vec3(-0.0765537734, 1.1762296998, -0.0996759264)),
                    dot(a, vec3(0.0083161484, -0.0060324498, 0.9977163014))), 0.0);
  c = 0.96 * c + dot(c, vec3(0.01088916, 0.02696328, 0.00214758));  // 4 % towards luminance: 0.04 · (0.272229, 0.674082, 0.0536895)
  c = c * (2.785085 * c + 0.107772) / (c * (2.936045 * c + 0.887122) + 0.806889);

  // Dim surround: luminance Y (of CIE XYZ) becomes Y^0.9811 at the same chromaticity, that is all of XYZ is multiplied by Y^−0.0189. The
  // published guards against division by zero act only where X + Y + Z < 1e-4 (Z is raised by what is missing) and where Y < 1e-8.
  float luma = dot(c, vec3(0.2722287168, 0.6740817658, 0.0536895174));
  float missing = max(1e-4 - dot(c, vec3(0.9291082484, 0.8121467058, 1.2202163047)), 0.0);
  float surround = exp2(-0.0189 * log2(max(luma, 1e-35))) * min(luma * 1e8, 1.0);

  // AP1 → XYZ → (surround) → AP1 → 7 % towards luminance → XYZ → D65 → Rec.709 in one matrix; its last column times `missing` for Z alone.
  return surround * (vec3(dot(c, vec3(1.60475401, -0.5310794904, -0.07367229607)),
                          dot(c, vec3(-0.1020831623, 1.108132314, -0.00605155829)),
                          dot(c, vec3(-0.003267022729, -0.07275523321, 1.076021917))) +
                     missing * vec3(-0.4611197491, 0.0367219018, 1.063087824));
}
