// SPDX-License-Identifier: MIT
#include "image/icc_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/printable.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

struct ContextCloser {
  void operator()(cmsContext c) const { cmsDeleteContext(c); }
};
struct ProfileCloser {
  void operator()(cmsHPROFILE p) const { cmsCloseProfile(p); }
};
struct TransformCloser {
  void operator()(cmsHTRANSFORM t) const { cmsDeleteTransform(t); }
};
using Context = std::unique_ptr<std::remove_pointer_t<cmsContext>, ContextCloser>;
using Profile = std::unique_ptr<void, ProfileCloser>;
using Transform = std::unique_ptr<void, TransformCloser>;

class LittleTransform : public ProfileTransform {
 public:
  LittleTransform(Context context, Transform transform)
      : context_(std::move(context)), transform_(std::move(transform)) {}
  void apply(float* rgb, std::size_t pixels) const override {
    cmsDoTransform(transform_.get(), rgb, rgb, static_cast<cmsUInt32Number>(pixels));
  }

 private:
  Context context_;  // outlives the transform
  Transform transform_;
};

bool like_srgb(const cmsToneCurve* curve) {
  constexpr double kTolerance = 1.0 / 1024;  // in encoded values: a quarter of an 8-bit step
  for (int i = 0; i <= 255; ++i) {
    const double x = i / 255.0;
    if (!(std::abs(linear_to_srgb(cmsEvalToneCurveFloat(curve, static_cast<float>(x))) - x) <= kTolerance))
      return false;
  }
  return true;
}

std::vector<float> table_of(const cmsToneCurve* curve, int max_code) {
  std::vector<float> table(static_cast<std::size_t>(max_code) + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = cmsEvalToneCurveFloat(curve, static_cast<float>(static_cast<double>(i) / max_code));
  return table;
}

const cmsToneCurve* curve_of(cmsHPROFILE profile, cmsTagSignature tag) {
  return static_cast<const cmsToneCurve*>(cmsReadTag(profile, tag));
}

Error refused(const char* why) { return Error{ErrorKind::io, why}; }

void use_curves(const std::array<const cmsToneCurve*, 3>& curves, const Matrix3& matrix, ColorEncoding& encoding) {
  if (std::all_of(curves.begin(), curves.end(), like_srgb)) {
    encoding.curve = TransferCurve::srgb;
  } else {
    encoding.curve = TransferCurve::tables;
    for (std::size_t c = 0; c < 3; ++c) encoding.tables[c] = table_of(curves[c], encoding.max_code);
  }
  constexpr double kSameMatrix = 3e-3;  // the rounding of published colorants
  if (nearly_equal(matrix, kIdentity, kSameMatrix)) {
    encoding.matrix.reset();
  } else {
    encoding.matrix = matrix;
  }
}

/// Red, green and blue colorants as columns, then to Rec.709; all zero when a tag is missing.
Matrix3 colorant_matrix(cmsHPROFILE profile) {
  Matrix3 to_xyz{};
  constexpr std::array kTags{cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile, kTags[c]));
    if (!xyz) return {};
    to_xyz[0][c] = xyz->X;
    to_xyz[1][c] = xyz->Y;
    to_xyz[2][c] = xyz->Z;
  }
  return multiply(xyz_d50_to_rec709(), to_xyz);
}

Profile linear_rec709(cmsContext context) {
  const cmsCIExyY white{kRec709.white[0], kRec709.white[1], 1};
  const cmsCIExyYTRIPLE primaries{{kRec709.red[0], kRec709.red[1], 1},
                                  {kRec709.green[0], kRec709.green[1], 1},
                                  {kRec709.blue[0], kRec709.blue[1], 1}};
  cmsToneCurve* linear = cmsBuildGamma(context, 1.0);
  cmsToneCurve* curves[3] = {linear, linear, linear};
  Profile profile(cmsCreateRGBProfileTHR(context, &white, &primaries, curves));
  cmsFreeToneCurve(linear);
  return profile;
}

/// Of grey by anything but a curve of light: a table, or a curve of lightness (L*), as profiles that meet in Lab have.
Result<void> use_grey_transform(cmsContext context, cmsHPROFILE profile, ColorEncoding& encoding) {
  const Profile target = linear_rec709(context);
  if (!target) return refused("has an ICC profile for which there is no memory");
  const Transform transform(cmsCreateTransformTHR(context, profile, TYPE_GRAY_FLT, target.get(), TYPE_RGB_FLT,
                                                  INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE));
  if (!transform) return refused("has an ICC profile that cannot be used");
  encoding.curve = TransferCurve::tables;
  for (auto& table : encoding.tables) table.resize(static_cast<std::size_t>(encoding.max_code) + 1);
  const std::size_t codes = encoding.tables[0].size();
  std::vector<float> grey(codes), rgb(3 * codes);
  for (std::size_t code = 0; code < codes; ++code)
    grey[code] = static_cast<float>(code) / static_cast<float>(encoding.max_code);
  cmsDoTransform(transform.get(), grey.data(), rgb.data(), static_cast<cmsUInt32Number>(codes));
  for (std::size_t i = 0; i < rgb.size(); ++i) encoding.tables[i % 3][i / 3] = rgb[i];
  encoding.matrix.reset();
  return {};
}

}  // namespace

Result<void> use_icc_profile(std::span<const std::uint8_t> bytes, int channels, ColorEncoding& encoding) {
  Context context(cmsCreateContext(nullptr, nullptr));
  if (!context) return refused("has an ICC profile for which there is no memory");
  const Profile profile(
      cmsOpenProfileFromMemTHR(context.get(), bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!profile) return refused("has a damaged ICC profile");
  const cmsColorSpaceSignature space = cmsGetColorSpace(profile.get());
  if (space == cmsSigGrayData) {
    if (channels != 1) return refused("has an ICC profile for grey pictures, but is in colour");
    if (encoding.max_code == 0) return refused("has an ICC profile for grey floating-point samples");
    const bool by_table = cmsIsTag(profile.get(), cmsSigAToB0Tag) || cmsIsTag(profile.get(), cmsSigAToB1Tag);
    if (by_table || cmsGetPCS(profile.get()) == cmsSigLabData)
      return use_grey_transform(context.get(), profile.get(), encoding);
    const cmsToneCurve* curve = curve_of(profile.get(), cmsSigGrayTRCTag);
    if (!curve) return refused("has an ICC profile without a curve");
    use_curves({curve, curve, curve}, kIdentity, encoding);
    return {};
  }
  if (space != cmsSigRgbData) return refused("has an ICC profile that is not for RGB pictures");

  const bool by_table = cmsIsTag(profile.get(), cmsSigAToB0Tag) || cmsIsTag(profile.get(), cmsSigAToB1Tag);
  if (!by_table && cmsIsMatrixShaper(profile.get()) && encoding.max_code > 0) {
    const std::array curves{curve_of(profile.get(), cmsSigRedTRCTag), curve_of(profile.get(), cmsSigGreenTRCTag),
                            curve_of(profile.get(), cmsSigBlueTRCTag)};
    const Matrix3 matrix = colorant_matrix(profile.get());
    if (!curves[0] || !curves[1] || !curves[2] || matrix == Matrix3{}) return refused("has a damaged ICC profile");
    use_curves(curves, matrix, encoding);
    return {};
  }
  const Profile target = linear_rec709(context.get());
  if (!target) return refused("has an ICC profile for which there is no memory");
  Transform transform(cmsCreateTransformTHR(context.get(), profile.get(), TYPE_RGB_FLT, target.get(), TYPE_RGB_FLT,
                                            INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE));
  if (!transform) return refused("has an ICC profile that cannot be used");
  encoding.transform = std::make_shared<LittleTransform>(std::move(context), std::move(transform));
  return {};
}

Result<DisplayProfile> display_profile(std::span<const std::uint8_t> bytes) {
  Context context(cmsCreateContext(nullptr, nullptr));
  if (!context) return refused("there is no memory for the ICC profile");
  const Profile profile(
      cmsOpenProfileFromMemTHR(context.get(), bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!profile) return refused("is no ICC profile, or a damaged one");
  if (cmsGetColorSpace(profile.get()) != cmsSigRgbData) return refused("is an ICC profile that is not of RGB");
  if (!cmsIsIntentSupported(profile.get(), INTENT_RELATIVE_COLORIMETRIC, LCMS_USED_AS_OUTPUT))
    return refused("is an ICC profile for reading alone: it does not say what a display is to be sent");
  const Profile source = linear_rec709(context.get());
  if (!source) return refused("there is no memory for the ICC profile");
  Transform transform(cmsCreateTransformTHR(context.get(), source.get(), TYPE_RGB_FLT, profile.get(), TYPE_RGB_FLT,
                                            INTENT_RELATIVE_COLORIMETRIC,
                                            cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE | cmsFLAGS_BLACKPOINTCOMPENSATION));
  if (!transform) return refused("is an ICC profile that cannot be used");
  DisplayProfile out;
  std::array<char, 128> name{};
  cmsGetProfileInfoASCII(profile.get(), cmsInfoDescription, "en", "US", name.data(), name.size());
  out.name = tidy_message(name.data(), 60);
  const auto made = std::make_shared<LittleTransform>(std::move(context), std::move(transform));
  out.apply = [made](float* rgb, std::size_t pixels) { made->apply(rgb, pixels); };
  return out;
}

std::vector<std::uint8_t> srgb_icc_profile() {
  const Context context(cmsCreateContext(nullptr, nullptr));
  const Profile profile(context ? cmsCreate_sRGBProfileTHR(context.get()) : nullptr);
  cmsUInt32Number size = 0;
  if (!profile || !cmsSaveProfileToMem(profile.get(), nullptr, &size)) return {};
  std::vector<std::uint8_t> bytes(size);
  if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) return {};
  // Little CMS writes the time of day; files must come out the same every time. Bytes 24–35: year, month, day, h, m, s.
  constexpr std::array<std::uint8_t, 12> kDate{0x07, 0xe8, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};
  if (bytes.size() > 36) std::copy(kDate.begin(), kDate.end(), bytes.begin() + 24);
  return bytes;
}

}  // namespace afterglow
