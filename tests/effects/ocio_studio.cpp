// SPDX-License-Identifier: MIT
#include "ocio_studio.h"

#include <fmt/format.h>

#include <cmath>

#include "files.h"

namespace afterglow {
namespace {

std::string film_cube(int size) {
  std::string out = fmt::format("LUT_3D_SIZE {}\n", size);
  const double last = size - 1;
  for (int b = 0; b < size; ++b)
    for (int g = 0; g < size; ++g)
      for (int r = 0; r < size; ++r)
        out += fmt::format("{:.6f} {:.6f} {:.6f}\n", std::pow(r / last, 1.5) * 0.9 + 0.1 * g / last,
                           std::pow(g / last, 1.4), 0.95 * std::pow(b / last, 1.3) + 0.05 * r / last);
  return out;
}

std::string film_curve(int length) {
  std::string out = fmt::format("Version 1\nFrom -0.1 1.2\nLength {}\nComponents 3\n{{\n", length);
  for (int i = 0; i < length; ++i) {
    const double x = i / double(length - 1);
    out += fmt::format("{:.7f} {:.7f} {:.7f}\n", std::pow(x, 0.6), std::pow(x, 0.65), x);
  }
  return out + "}\n";
}

std::string half_curve() {
  std::string rows;
  for (int bits = 0; bits < 65536; ++bits) {
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    double v = exponent == 0 ? mantissa * std::exp2(-24) : (1024 + mantissa) * std::exp2(exponent - 25);
    if (exponent == 31) v = 65504;
    rows += fmt::format("{:.7f}\n", (bits & 32768 ? -1 : 1) * v / (v + 0.8));
  }
  return "<?xml version=\"1.0\"?><ProcessList id=\"p\" compCLFversion=\"3\"><LUT1D inBitDepth=\"32f\" "
         "outBitDepth=\"32f\" halfDomain=\"true\"><Array dim=\"65536 1\">" +
         rows + "</Array></LUT1D></ProcessList>\n";
}

struct StudioView {
  std::string name, steps;
};

// Each as the from_scene_reference of a colour space; the reference is ACES2065-1.
const std::vector<StudioView>& steps_of_views() {
  static const std::vector<StudioView> all{
      {"matrix",
       "!<MatrixTransform> {matrix: [0.9, 0.08, 0.02, 0, 0.05, 0.9, 0.05, 0, 0.02, 0.08, 0.9, 0, 0, 0, 0, 1], offset: "
       "[0.01, 0.02, 0, 0]}"},
      {"range", "!<RangeTransform> {min_in_value: 0.01, max_in_value: 0.9, min_out_value: 0, max_out_value: 1}"},
      {"exponent", "!<ExponentTransform> {value: [2.2, 2.3, 2.4, 1], style: mirror, direction: inverse}"},
      {"exponent with toe", "!<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse}"},
      {"logarithm", "!<LogTransform> {base: 10}"},
      {"log affine",
       "!<LogAffineTransform> {base: 2, lin_side_offset: 0.00390625, log_side_slope: 0.07, log_side_offset: 0.6}"},
      {"log camera",
       "!<LogCameraTransform> {base: 10, lin_side_break: 0.010591, lin_side_slope: 5.555556, lin_side_offset: "
       "0.052272, "
       "log_side_slope: 0.24719, log_side_offset: 0.385537, linear_slope: 5.367655}"},
      {"cdl", "!<CDLTransform> {slope: [1.05, 1.02, 1], offset: [0.01, 0, -0.01], power: [1.2, 1, 0.9], sat: 1.25}"},
      {"cdl of asc, back",
       "!<CDLTransform> {slope: [1.1, 1, 1], power: [1.2, 1, 0.9], sat: 0.8, style: asc, direction: inverse}"},
      {"exposure contrast",
       "!<ExposureContrastTransform> {style: log, exposure: 0.5, contrast: 1.2, gamma: 1.1, pivot: 0.18}"},
      {"curve", "!<FileTransform> {src: curve.spi1d, interpolation: linear}"},
      {"curve, back", "!<FileTransform> {src: curve.spi1d, interpolation: linear, direction: inverse}"},
      {"curve of 5000", "!<FileTransform> {src: long.spi1d, interpolation: linear}"},
      {"curve of halfs", "!<FileTransform> {src: half.clf}"},
      {"cube, tetrahedral", "!<FileTransform> {src: film.cube, interpolation: tetrahedral}"},
      {"cube, linear", "!<FileTransform> {src: film.cube, interpolation: linear}"},
      {"cube, back", "!<FileTransform> {src: film.cube, interpolation: tetrahedral, direction: inverse}"},
      {"gamut compression",
       "!<FixedFunctionTransform> {style: ACES_GamutComp13, params: [1.147, 1.264, 1.312, 0.815, 0.803, 0.88, 1.2]}"},
      {"hsv, less saturated",
       "!<GroupTransform> {children: [!<FixedFunctionTransform> {style: RGB_TO_HSV}, !<MatrixTransform> {matrix: [1, "
       "0, "
       "0, 0, 0, 0.7, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, !<FixedFunctionTransform> {style: RGB_TO_HSV, direction: "
       "inverse}]}"},
      {"surround", "!<FixedFunctionTransform> {style: REC2100_Surround, params: [0.78]}"},
      {"grade, primary",
       "!<GradingPrimaryTransform> {style: log, contrast: {rgb: [1.1, 1, 1.1], master: 1.1}, saturation: 1.2}"},
      {"grade, tone",
       "!<GradingToneTransform> {style: log, midtones: {rgb: [1.2, 1, 1], master: 1.1, center: 0.4, width: 0.6}}"},
      {"grade, curves", "!<GradingRGBCurveTransform> {style: log, red: {control_points: [0, 0, 0.5, 0.6, 1, 1]}}"},
      {"film",
       "!<GroupTransform> {children: [!<MatrixTransform> {matrix: [0.9, 0.08, 0.02, 0, 0.05, 0.9, 0.05, 0, 0.02, 0.08, "
       "0.9, 0, 0, 0, 0, 1]}, !<LogAffineTransform> {base: 2, lin_side_offset: 0.00390625, log_side_slope: 0.07, "
       "log_side_offset: 0.6}, !<FileTransform> {src: film.cube, interpolation: tetrahedral}, !<FileTransform> {src: "
       "curve.spi1d}, !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse}]}"},
  };
  return all;
}

const std::vector<std::string>& other_views() {
  static const std::vector<std::string> all{"ACES", "ACES, looked at", "ACES, PQ"};
  return all;
}

}  // namespace

const std::vector<std::string>& studio_views() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const auto& view : steps_of_views()) names.push_back(view.name);
    names.insert(names.end(), other_views().begin(), other_views().end());
    return names;
  }();
  return all;
}

std::filesystem::path write_studio() {
  write_test_file("tables/film.cube", film_cube(17));
  write_test_file("tables/curve.spi1d", film_curve(64));
  write_test_file("tables/long.spi1d", film_curve(5000));
  write_test_file("tables/half.clf", half_curve());
  std::string views, spaces;
  for (const auto& view : steps_of_views()) {
    views += fmt::format("    - !<View> {{name: \"{0}\", colorspace: \"{0}\"}}\n", view.name);
    spaces += fmt::format("  - !<ColorSpace>\n    name: \"{}\"\n    from_scene_reference: {}\n", view.name, view.steps);
  }
  return write_test_file("studio.ocio", R"(ocio_profile_version: 2.1
search_path: tables
strictparsing: true
roles: {default: lin_rec709, scene_linear: lin_rec709, aces_interchange: aces}
file_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]
displays:
  Monitor:
)" + views + R"(    - !<View> {name: ACES, view_transform: sdr, display_colorspace: sRGB}
    - !<View> {name: "ACES, looked at", view_transform: sdr, display_colorspace: sRGB, looks: "+warm, -contrast"}
    - !<View> {name: "ACES, PQ", view_transform: hdr, display_colorspace: PQ}
looks:
  - !<Look>
    name: warm
    process_space: film
    transform: !<CDLTransform> {slope: [1.1, 1, 0.9]}
  - !<Look>
    name: contrast
    process_space: lin_rec709
    transform: !<ExponentTransform> {value: [1.1, 1.1, 1.1, 1]}
view_transforms:
  - !<ViewTransform>
    name: sdr
    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}
  - !<ViewTransform>
    name: hdr
    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - HDR-VIDEO-1000nit-15nit-REC2020lim_1.1}
display_colorspaces:
  - !<ColorSpace>
    name: sRGB
    from_display_reference: !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_sRGB}
  - !<ColorSpace>
    name: PQ
    from_display_reference: !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_REC.2100-PQ}
colorspaces:
  - !<ColorSpace>
    name: aces
  - !<ColorSpace>
    name: lin_rec709
    to_scene_reference: !<MatrixTransform> {matrix: [0.439632981919, 0.382988698151, 0.177378319930, 0, 0.089776442959, 0.813439428749, 0.096784128292, 0, 0.017541170380, 0.111546553302, 0.870912276318, 0, 0, 0, 0, 1]}
)" + spaces);
}

std::filesystem::path write_old_studio() {
  write_test_file("luts/film.cube", film_cube(9));
  write_test_file("luts/log.spi1d", film_curve(1024));
  return write_test_file("old.ocio", R"(ocio_profile_version: 1
search_path: luts
strictparsing: false
luma: [0.2126, 0.7152, 0.0722]
roles:
  default: raw
  scene_linear: lin_srgb
  reference: lin_srgb
displays:
  Old:
    - !<View> {name: Film, colorspace: film}
    - !<View> {name: Log, colorspace: log}
    - !<View> {name: Looked, colorspace: log, looks: +graded}
    - !<View> {name: Raw, colorspace: raw}
active_displays: [Old]
active_views: [Film, Log, Looked, Raw]
looks:
  - !<Look>
    name: graded
    process_space: log
    transform: !<CDLTransform> {slope: [1.1, 1, 0.9], offset: [0.01, 0, 0], power: [1, 1.1, 1], sat: 1.1}
colorspaces:
  - !<ColorSpace>
    name: lin_srgb
    family: ln
    equalitygroup: ""
    bitdepth: 32f
    isdata: false
    allocation: lg2
    allocationvars: [-15, 6]
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: log
    allocation: uniform
    allocationvars: [0, 1]
    to_reference: !<FileTransform> {src: log.spi1d, interpolation: linear, direction: inverse}
  - !<ColorSpace>
    name: film
    from_reference: !<GroupTransform>
      children:
        - !<AllocationTransform> {allocation: lg2, vars: [-12, 7]}
        - !<FileTransform> {src: film.cube, interpolation: linear}
        - !<ExponentTransform> {value: [1.1, 1.1, 1.1, 1]}
)");
}

}  // namespace afterglow
