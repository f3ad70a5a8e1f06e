// How colours are encoded for people's tables: scene-linear Rec.709 to one of these, and back.
// 0: as they are. 1: sRGB (IEC 61966-2-1). 2: ACEScct (S-2016-001) of AP1.

vec3 srgb_from_linear(vec3 c) {
  c = max(c, vec3(0.0));
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 linear_from_srgb(vec3 c) {
  c = min(c, vec3(1e12));  // to the 2.4 it still is a number
  return mix(pow((max(c, vec3(0.0)) + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// Rec.709 to AP1 over XYZ, white point D65 to D60 by CAT02 Bradford (as OpenColorIO's ACES configurations have it).
const mat3 kAp1FromRec709 = mat3(0.6130974024, 0.0701937225, 0.0206155929, 0.3395231462, 0.9163538791, 0.1095697729, 0.0473794514,
                                 0.0134523985, 0.8698146342);
const mat3 kRec709FromAp1 = mat3(1.7050509927, -0.1302564175, -0.0240033568, -0.6217921207, 1.1408047366, -0.1289689761, -0.0832588720,
                                 -0.0105483191, 1.1529723329);

vec3 acescct_from_linear(vec3 c) {
  c = kAp1FromRec709 * c;
  return mix((log2(max(c, vec3(1e-10))) + 9.72) / 17.52, 10.5402377416545 * c + 0.0729055341958355, lessThanEqual(c, vec3(0.0078125)));
}

vec3 linear_from_acescct(vec3 c) {
  vec3 high = exp2(min(c, vec3(1.4679964)) * 17.52 - 9.72);
  vec3 low = (max(c, vec3(-1e12)) - 0.0729055341958355) / 10.5402377416545;
  return kRec709FromAp1 * mix(high, low, lessThanEqual(c, vec3(0.155251141552511)));
}

vec3 encoded(vec3 c, int encoding) {
  return encoding == 1 ? srgb_from_linear(c) : encoding == 2 ? acescct_from_linear(c) : c;
}

vec3 decoded(vec3 c, int encoding) {
  return encoding == 1 ? linear_from_srgb(c) : encoding == 2 ? linear_from_acescct(c) : c;
}
