// SPDX-License-Identifier: MIT
// How colours are encoded for people's tables: scene-linear Rec.709 to one of these, and back (math.md §24 has the papers). Light beyond
// what a float holds of a curve's inverse is cut off: it stays finite, and rises as far as it goes.

#include "lib/near_one.glsl"

const int kEncodingLinear = 0, kEncodingSrgb = 1, kEncodingAcescct = 2, kEncodingLogC3 = 3, kEncodingLogC4 = 4, kEncodingSlog3 = 5, kEncodingPq = 6,
          kEncodingHlg = 7, kEncodingGamma22 = 8, kEncodingGamma24 = 9, kEncodingCineon = 10, kEncodingRec709 = 11, kEncodingAppleLog = 12, kEncodingBmdFilm5 = 13,
          kEncodingClog2 = 14, kEncodingClog3 = 15, kEncodingDavinci = 16, kEncodingLog3G10 = 17, kEncodingSlog3SGamut3 = 18, kEncodingVlog = 19;

vec3 srgb_from_linear(vec3 c) {
  c = max(c, vec3(0.0));
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 linear_from_srgb(vec3 c) {
  c = min(c, vec3(1e12));  // to the 2.4 it still is a number
  return mix(pow((max(c, vec3(0.0)) + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// The same of 0…1 alone, as minimax polynomials, for a third of what powers take on CPU devices. The first is one of the fourth root, off by
// 8e-8; the second of √(v + 0.055), off by 1e-7.
vec3 srgb_from_linear_unit(vec3 c) {
  vec3 s = sqrt(sqrt(c));
  vec3 high = -0.05771828446 + s * (0.1114585153 + s * (1.546336874 + s * (-1.482262217 + s * (1.965444529 + s * (-1.981219015 + s * (1.332198988 + s * (-0.5260404244 + s * 0.09180111322)))))));
  return mix(high, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 linear_from_srgb_unit(vec3 c) {
  vec3 s = sqrt(c + 0.055);
  vec3 high = 0.0003789689624 + s * (-0.005093005266 + s * (0.02969995899 + s * (-0.1026917758 + s * (0.2805346396 + s * (0.7066986407 + s * -0.03011187887)))));
  return mix(high, c * (1.0 / 12.92), lessThanEqual(c, vec3(0.04045)));
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

// From and to Rec.709 of the other primaries; all white points are D65, but for a digit of Blackmagic's.
const mat3 kWideGamut3FromRec709 = mat3(0.6313210225, 0.0368199337, 0.0173697319, 0.2708007273, 0.7930369660, 0.1487891849, 0.0978782502,
                                        0.1701431002, 0.8338410832);
const mat3 kRec709FromWideGamut3 = mat3(1.6175234363, -0.0705727409, -0.0211017280, -0.5372866222, 1.3346130623, -0.2269538752, -0.0802368141,
                                        -0.2640403214, 1.2480556033);
const mat3 kWideGamut4FromRec709 = mat3(0.5658365405, 0.0886256369, 0.0177500401, 0.3403309987, 0.8093468418, 0.1094476209, 0.0938324608,
                                        0.1020275213, 0.8728023391);
const mat3 kRec709FromWideGamut4 = mat3(1.8931234427, -0.2057003583, -0.0127057429, -0.7808815036, 1.3402574894, -0.1521848758, -0.1122419390,
                                        -0.1345571311, 1.1648906187);
const mat3 kSGamut3CineFromRec709 = mat3(0.6456794776, 0.0875299915, 0.0369574199, 0.2591145470, 0.7596995626, 0.1292809048, 0.0952059754,
                                         0.1527704459, 0.8337616753);
const mat3 kRec709FromSGamut3Cine = mat3(1.6269474097, -0.1785155271, -0.0444361150, -0.5401385389, 1.4179409275, -0.1959199662, -0.0868088709,
                                         -0.2394254003, 1.2403560812);
const mat3 kRec2020FromRec709 = mat3(0.6274038959, 0.0690972894, 0.0163914389, 0.3292830384, 0.9195403951, 0.0880133079, 0.0433130657,
                                     0.0113623156, 0.8955952532);
const mat3 kRec709FromRec2020 = mat3(1.6604910021, -0.1245504745, -0.0181507634, -0.5876411388, 1.1328998971, -0.1005788980, -0.0728498633,
                                     -0.0083494226, 1.1187296614);

const mat3 kSGamut3FromRec709 = mat3(0.5660490800, 0.0769613789, 0.0223509133, 0.3427630874, 0.7990545001,
                                     0.1086120512, 0.0911878326, 0.1239841211, 0.8690370356);
const mat3 kRec709FromSGamut3 = mat3(1.8779151284, -0.1768069813, -0.0262011264, -0.7941687613, 1.3509996209,
                                     -0.1484222623, -0.0837463671, -0.1741926396, 1.1746233888);
const mat3 kVGamutFromRec709 = mat3(0.5851961465, 0.0785885674, 0.0227942379, 0.3226416225, 0.8196271147,
                                    0.1142170237, 0.0921622310, 0.1017843179, 0.8629887384);
const mat3 kRec709FromVGamut = mat3(1.8065758837, -0.1700903431, -0.0252057840, -0.6956972741, 1.3059552161,
                                    -0.1544683294, -0.1108786096, -0.1358648730, 1.1796741134);
const mat3 kCinemaGamutFromRec709 = mat3(0.5561574826, 0.0824132532, 0.0331044723, 0.3291746081, 0.7574697865,
                                         0.2258119600, 0.1146679093, 0.1601169603, 0.7410835677);
const mat3 kRec709FromCinemaGamut = mat3(1.9238612959, -0.2043108482, -0.0236850210, -0.7987606632, 1.4958985098,
                                         -0.4201270110, -0.1251006327, -0.2915876616, 1.4438120320);
const mat3 kRedWideGamutFromRec709 = mat3(0.5419461842, 0.0769893299, 0.0588723347, 0.3601481599, 0.7679683123,
                                          0.2734946565, 0.0979056560, 0.1550423578, 0.6676330088);
const mat3 kRec709FromRedWideGamut = mat3(1.9819760180, -0.1781431821, -0.1017959660, -0.9004318366, 1.5004683579,
                                          -0.5352634592, -0.0815441813, -0.3223251759, 1.6370594252);
const mat3 kDavinciWideGamutFromRec709 = mat3(0.5627674560, 0.0777546353, 0.0646691999, 0.3235165887, 0.7495773462,
                                              0.1919986920, 0.1137159553, 0.1726680186, 0.7433321080);
const mat3 kRec709FromDavinciWideGamut = mat3(1.8986148993, -0.1689487865, -0.1215391606, -0.7921761834, 1.4889757541,
                                              -0.3156758531, -0.1064387159, -0.3200269676, 1.4372150137);
const mat3 kFilmWideGamut5FromRec709 = mat3(0.6549156767, 0.0488890079, 0.0355579400, 0.2686772608, 0.7920131719,
                                            0.1624108974, 0.0764070625, 0.1590978202, 0.8020311625);
const mat3 kRec709FromFilmWideGamut5 = mat3(1.5684149691, -0.0863591234, -0.0520477815, -0.5226802154, 1.3449223531,
                                            -0.2491731294, -0.0457347537, -0.2585632297, 1.3012209108);

const float kLog2Of10 = 3.321928094887362;

// ARRI LogC3 at EI 800, of ALEXA Wide Gamut 3: c·log10(ax + b) + d above 0.010591, else ex + f.
vec3 logc3_from_linear(vec3 c) {
  c = kWideGamut3FromRec709 * c;
  vec3 high = (0.247190 / kLog2Of10) * log2(max(5.555556 * c + 0.052272, vec3(1e-10))) + 0.385537;
  return mix(high, 5.367655 * c + 0.092809, lessThanEqual(c, vec3(0.010591)));
}

vec3 linear_from_logc3(vec3 v) {
  vec3 high = (exp2((min(v, vec3(7.0)) - 0.385537) * (kLog2Of10 / 0.247190)) - 0.052272) / 5.555556;
  return kRec709FromWideGamut3 * mix(high, (max(v, vec3(-1e12)) - 0.092809) / 5.367655, lessThanEqual(v, vec3(0.149657834)));
}

// ARRI LogC4, of ARRI Wide Gamut 4: b·(log2(ax + 64) − 6)/14 + c from t on, else a line.
vec3 logc4_from_linear(vec3 x) {
  x = kWideGamut4FromRec709 * x;
  vec3 high = (log2(max(2231.8263090676883 * x + 64.0, vec3(1e-10))) - 6.0) * 0.06479542593 + 0.09286412512218964;
  return mix((x + 0.018056996119911) / 0.1135972086105891, high, greaterThanEqual(x, vec3(-0.018056996119911)));
}

vec3 linear_from_logc4(vec3 v) {
  vec3 high = (exp2((min(v, vec3(7.0)) - 0.09286412512218964) * 15.433189655172415 + 6.0) - 64.0) / 2231.8263090676883;
  return kRec709FromWideGamut4 * mix(max(v, vec3(-1e12)) * 0.1135972086105891 - 0.018056996119911, high, greaterThanEqual(v, vec3(0.0)));
}

// Sony S-Log3, of S-Gamut3.Cine and of S-Gamut3.
vec3 slog3_code(vec3 x) {
  vec3 high = (420.0 + (261.5 / kLog2Of10) * log2(max((x + 0.01) / 0.19, vec3(1e-10)))) / 1023.0;
  return mix((x * (76.2102946929 / 0.01125) + 95.0) / 1023.0, high, greaterThanEqual(x, vec3(0.01125)));
}

vec3 slog3_light(vec3 v) {
  vec3 high = exp2((min(v, vec3(8.0)) * 1023.0 - 420.0) * (kLog2Of10 / 261.5)) * 0.19 - 0.01;
  return mix((max(v, vec3(-1e12)) * 1023.0 - 95.0) * (0.01125 / 76.2102946929), high, greaterThanEqual(v, vec3(171.2102946929 / 1023.0)));
}

vec3 slog3_from_linear(vec3 x) { return slog3_code(kSGamut3CineFromRec709 * x); }
vec3 linear_from_slog3(vec3 v) { return kRec709FromSGamut3Cine * slog3_light(v); }
vec3 slog3_sgamut3_from_linear(vec3 x) { return slog3_code(kSGamut3FromRec709 * x); }
vec3 linear_from_slog3_sgamut3(vec3 v) { return kRec709FromSGamut3 * slog3_light(v); }

// Panasonic V-Log, of V-Gamut.
vec3 vlog_from_linear(vec3 x) {
  x = kVGamutFromRec709 * x;
  vec3 high = (0.241514 / kLog2Of10) * log2(max(x + 0.00873, vec3(1e-10))) + 0.598206;
  return mix(high, 5.6 * x + 0.125, lessThan(x, vec3(0.01)));
}

vec3 linear_from_vlog(vec3 v) {
  vec3 high = exp2((min(v, vec3(7.0)) - 0.598206) * (kLog2Of10 / 0.241514)) - 0.00873;
  return kRec709FromVGamut * mix(high, (max(v, vec3(-1e12)) - 0.125) / 5.6, lessThan(v, vec3(0.181)));
}

// Canon Log 2 and 3, of Cinema Gamut; their 1 is a reflectance of 0.9. Both are logarithms on both sides of black, and the third a line between.
vec3 clog2_from_linear(vec3 x) {
  x = kCinemaGamutFromRec709 * x;
  return sign(x) * (0.24136077 / kLog2Of10) * log2(abs(x) * (87.099375 / 0.9) + 1.0) + 0.092864125;
}

vec3 linear_from_clog2(vec3 v) {
  v = clamp(v, -7.0, 7.0) - 0.092864125;
  return kRec709FromCinemaGamut * (sign(v) * (exp2(abs(v) * (kLog2Of10 / 0.24136077)) - 1.0) * (0.9 / 87.099375));
}

vec3 clog3_from_linear(vec3 x) {
  x = kCinemaGamutFromRec709 * x;
  vec3 far = (0.36726845 / kLog2Of10) * log2(abs(x) * (14.98325 / 0.9) + 1.0);
  vec3 ends = mix(0.12783901 - far, far + 0.12240537, greaterThan(x, vec3(0.0)));
  return mix(ends, x * (1.9754798 / 0.9) + 0.12512219, lessThanEqual(abs(x), vec3(0.0126)));
}

vec3 linear_from_clog3(vec3 v) {
  v = clamp(v, -7.0, 7.0);
  bvec3 below = lessThan(v, vec3(0.097465473)), above = greaterThan(v, vec3(0.15277891));
  vec3 rest = exp2(mix(0.12783901 - v, v - 0.12240537, above) * (kLog2Of10 / 0.36726845)) - 1.0;
  vec3 middle = (v - 0.12512219) * (0.9 / 1.9754798);
  return kRec709FromCinemaGamut * mix(mix(middle, rest * (0.9 / 14.98325), above), rest * (-0.9 / 14.98325), below);
}

// RED Log3G10, of REDWideGamutRGB: a line below −0.01.
vec3 log3g10_from_linear(vec3 x) {
  x = kRedWideGamutFromRec709 * x + 0.01;
  return mix((0.224282 / kLog2Of10) * log2(max(x, vec3(0.0)) * 155.975327 + 1.0), x * 15.1927, lessThan(x, vec3(0.0)));
}

vec3 linear_from_log3g10(vec3 v) {
  vec3 high = (exp2(min(v, vec3(7.0)) * (kLog2Of10 / 0.224282)) - 1.0) / 155.975327;
  return kRec709FromRedWideGamut * (mix(high, max(v, vec3(-1e12)) / 15.1927, lessThan(v, vec3(0.0))) - 0.01);
}

// DaVinci Intermediate, of DaVinci Wide Gamut.
vec3 davinci_intermediate_from_linear(vec3 x) {
  x = kDavinciWideGamutFromRec709 * x;
  return mix((log2(max(x + 0.0075, vec3(1e-10))) + 7.0) * 0.07329248, x * 10.44426855, lessThanEqual(x, vec3(0.00262409)));
}

vec3 linear_from_davinci_intermediate(vec3 v) {
  vec3 high = exp2(min(v, vec3(7.0)) / 0.07329248 - 7.0) - 0.0075;
  return kRec709FromDavinciWideGamut * mix(high, max(v, vec3(-1e12)) / 10.44426855, lessThanEqual(v, vec3(0.02740668)));
}

// Blackmagic Film, generation 5, of its Wide Gamut.
vec3 bmd_film5_from_linear(vec3 x) {
  x = kFilmWideGamut5FromRec709 * x;
  vec3 high = 0.08692876065491224 * log(max(x + 0.005494072432257808, vec3(1e-10))) + 0.5300133392291939;
  return mix(high, 8.283605932402494 * x + 0.09246575342465753, lessThan(x, vec3(0.005)));
}

vec3 linear_from_bmd_film5(vec3 v) {
  vec3 high = exp((min(v, vec3(7.0)) - 0.5300133392291939) / 0.08692876065491224) - 0.005494072432257808;
  return kRec709FromFilmWideGamut5 * mix(high, (max(v, vec3(-1e12)) - 0.09246575342465753) / 8.283605932402494, lessThan(v, vec3(0.13388378308)));
}

// Apple Log, of Rec.2020: a root below 0.01, and no code below −0.056.
vec3 apple_log_from_linear(vec3 x) {
  x = kRec2020FromRec709 * x;
  vec3 low = max(x + 0.05641088, vec3(0.0));
  return mix(0.08550479 * log2(max(x + 0.00964052, vec3(1e-10))) + 0.69336945, 47.28711236 * low * low, lessThan(x, vec3(0.01)));
}

vec3 linear_from_apple_log(vec3 v) {
  vec3 high = exp2((min(v, vec3(7.0)) - 0.69336945) / 0.08550479) - 0.00964052;
  return kRec709FromRec2020 * mix(high, sqrt(max(v, vec3(0.0)) / 47.28711236) - 0.05641088, lessThan(v, vec3(0.20855531595)));
}

// PQ (SMPTE ST 2084) of Rec.2020; 203 cd/m² is 1. Light below black has no code. With w = 1 − c1 = c2 − c3 the papers' fractions are written by what is
// left of 1, where powers of 79 and 1/79 have their digits: (c1 + c2·y)/(1 + c3·y) = 1 − w(1 − y)/(1 + c3·y), and (n − c1)/(c2 − c3·n) = (w − (1 − n))/(w + c3(1 − n)).
vec3 pq_from_linear(vec3 x) {
  vec3 y = pow(max(kRec2020FromRec709 * x, vec3(0.0)) * 0.0203, vec3(0.1593017578125));
  return exp(78.84375 * log_of_one_plus(-0.1640625 * (1.0 - y) / (1.0 + 18.6875 * y)));
}

vec3 linear_from_pq(vec3 v) {
  vec3 rest = one_minus_exp(log(clamp(v, 1e-30, 1.0)) / 78.84375);
  return kRec709FromRec2020 * (pow(max(0.1640625 - rest, vec3(0.0)) / (0.1640625 + 18.6875 * rest), vec3(1.0 / 0.1593017578125)) / 0.0203);
}

// HLG (ITU-R BT.2100), light of the scene, of Rec.2020; the signal 0.75 is 1. Light below black has no code.
vec3 hlg_from_linear(vec3 x) {
  x = max(kRec2020FromRec709 * x, vec3(0.0)) * 0.26496256;
  return mix(0.17883277 * log(max(12.0 * x - 0.28466892, vec3(1e-10))) + 0.55991073, sqrt(3.0 * x), lessThanEqual(x, vec3(1.0 / 12.0)));
}

vec3 linear_from_hlg(vec3 v) {
  v = max(v, vec3(0.0));
  vec3 high = (exp((min(v, vec3(4.0)) - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
  return kRec709FromRec2020 * (mix(high, v * v / 3.0, lessThanEqual(v, vec3(0.5))) / 0.26496256);
}

// A plain power, mirrored below 0.
vec3 power_from_linear(vec3 c, float gamma) { return sign(c) * pow(abs(c), vec3(1.0 / gamma)); }
vec3 linear_from_power(vec3 v, float gamma) { return sign(v) * pow(min(abs(v), vec3(1e12)), vec3(gamma)); }

// Cineon printing density: codes of 1023 count 0.002, 95 is black, 685 white, film's gamma 0.6.
const float kCineonBlack = 0.0107977516;  // 10^(0.002·(95 − 685)/0.6)
vec3 cineon_from_linear(vec3 x) {
  return (685.0 + (300.0 / kLog2Of10) * log2(max(x * (1.0 - kCineonBlack) + kCineonBlack, vec3(1e-10)))) / 1023.0;
}
vec3 linear_from_cineon(vec3 v) {
  return (exp2((min(v, vec3(8.0)) * 1023.0 - 685.0) * (kLog2Of10 / 300.0)) - kCineonBlack) / (1.0 - kCineonBlack);
}

// The curve of cameras (ITU-R BT.709, digits of BT.2020), odd around 0.
const float kCameraAlpha = 1.09929682680944, kCameraBeta = 0.018053968510807;
vec3 rec709_from_linear(vec3 c) {
  vec3 a = abs(c);
  return sign(c) * mix(kCameraAlpha * pow(a, vec3(0.45)) - (kCameraAlpha - 1.0), 4.5 * a, lessThan(a, vec3(kCameraBeta)));
}
vec3 linear_from_rec709(vec3 v) {
  vec3 a = min(abs(v), vec3(1e12));
  return sign(v) * mix(pow((a + (kCameraAlpha - 1.0)) / kCameraAlpha, vec3(1.0 / 0.45)), a / 4.5, lessThan(a, vec3(4.5 * kCameraBeta)));
}

vec3 encoded(vec3 c, int encoding) {
  if (encoding == kEncodingSrgb) return srgb_from_linear(c);
  if (encoding == kEncodingAcescct) return acescct_from_linear(c);
  if (encoding == kEncodingLogC3) return logc3_from_linear(c);
  if (encoding == kEncodingLogC4) return logc4_from_linear(c);
  if (encoding == kEncodingSlog3) return slog3_from_linear(c);
  if (encoding == kEncodingPq) return pq_from_linear(c);
  if (encoding == kEncodingHlg) return hlg_from_linear(c);
  if (encoding == kEncodingGamma22) return power_from_linear(c, 2.2);
  if (encoding == kEncodingGamma24) return power_from_linear(c, 2.4);
  if (encoding == kEncodingCineon) return cineon_from_linear(c);
  if (encoding == kEncodingRec709) return rec709_from_linear(c);
  if (encoding == kEncodingAppleLog) return apple_log_from_linear(c);
  if (encoding == kEncodingBmdFilm5) return bmd_film5_from_linear(c);
  if (encoding == kEncodingClog2) return clog2_from_linear(c);
  if (encoding == kEncodingClog3) return clog3_from_linear(c);
  if (encoding == kEncodingDavinci) return davinci_intermediate_from_linear(c);
  if (encoding == kEncodingLog3G10) return log3g10_from_linear(c);
  if (encoding == kEncodingSlog3SGamut3) return slog3_sgamut3_from_linear(c);
  if (encoding == kEncodingVlog) return vlog_from_linear(c);
  return c;
}

vec3 decoded(vec3 c, int encoding) {
  if (encoding == kEncodingSrgb) return linear_from_srgb(c);
  if (encoding == kEncodingAcescct) return linear_from_acescct(c);
  if (encoding == kEncodingLogC3) return linear_from_logc3(c);
  if (encoding == kEncodingLogC4) return linear_from_logc4(c);
  if (encoding == kEncodingSlog3) return linear_from_slog3(c);
  if (encoding == kEncodingPq) return linear_from_pq(c);
  if (encoding == kEncodingHlg) return linear_from_hlg(c);
  if (encoding == kEncodingGamma22) return linear_from_power(c, 2.2);
  if (encoding == kEncodingGamma24) return linear_from_power(c, 2.4);
  if (encoding == kEncodingCineon) return linear_from_cineon(c);
  if (encoding == kEncodingRec709) return linear_from_rec709(c);
  if (encoding == kEncodingAppleLog) return linear_from_apple_log(c);
  if (encoding == kEncodingBmdFilm5) return linear_from_bmd_film5(c);
  if (encoding == kEncodingClog2) return linear_from_clog2(c);
  if (encoding == kEncodingClog3) return linear_from_clog3(c);
  if (encoding == kEncodingDavinci) return linear_from_davinci_intermediate(c);
  if (encoding == kEncodingLog3G10) return linear_from_log3g10(c);
  if (encoding == kEncodingSlog3SGamut3) return linear_from_slog3_sgamut3(c);
  if (encoding == kEncodingVlog) return linear_from_vlog(c);
  return c;
}
