// SPDX-License-Identifier: MIT
// What the bench has found, as plain data. Times are milliseconds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/statistics.h"
#include "core/geometry.h"
#include "exec/frame.h"
#include "image/metrics.h"

namespace afterglow::bench {

/// How far a picture is from the true one.
struct Quality {
  ErrorMeasure error;             ///< math.md §13, over R, G and B
  double psnr = 0;                ///< dB, of the pictures as a display gets them: clamped and sRGB-encoded
  std::optional<double> visible;  ///< share of pixels that people would see to differ (Yee); empty: not measured
};

/// One choice for one preset at one size.
struct Point {
  std::string choice;    ///< `execution_name`
  std::string label;     ///< as it was asked for: "plain16f", "chosen", or the choice's own name
  std::string settings;  ///< what was varied: "glow.scatter=0.5"; empty: as the preset says
  Spread execute;        ///< recorded once and submitted; without upload and read-back
  double upload = 0, read_back = 0;
  int kernels = 0;
  std::uint64_t image_memory = 0;  ///< bytes between passes
  std::uint64_t traffic = 0;       ///< bytes that kernels read and write: graph/memory.h
  std::uint64_t unavoidable = 0;   ///< of them, what no way can spare
  std::vector<KernelTime> passes;  ///< each alone
  std::optional<Quality> quality;  ///< empty: there was nothing to compare with
  bool front = false;              ///< nothing else is both faster and closer to the truth
};

/// One preset at one size; everything in it was measured in turns.
struct Cell {
  std::string preset;
  Size size;
  std::string truth;  ///< what errors are measured against: "double precision", "--reference", or why there is nothing
  Spread copy;        ///< one RGBA32F pass of texelFetch over the whole picture
  Spread memory;      ///< a plain copy of as many bytes by the device
  double gigabytes_per_second = 0;  ///< read and written by that copy
  std::vector<Point> points;
};

/// A ratio that the project wants to reach.
struct GoalResult {
  std::string name, size;
  std::optional<double> ratio;  ///< empty: not measured, see `note`
  double goal = 0;
  std::optional<double> next;  ///< the goal after that
  bool at_least = false;       ///< else: at most
  std::string unit;            ///< "" (a ratio) or "s"
  std::string note;
  bool reached() const { return ratio && (at_least ? *ratio >= goal : *ratio <= goal); }
};

/// How steady what a look adds is over the frames of a shot. Shares are of the mean over the frames.
struct TemporalCurve {
  std::string preset, settings;
  std::string scene;  ///< "highlight of 0.5 px", or the files
  Size size;
  double radius = 0;          ///< of the highlight, pixels; 0: another scene
  std::vector<double> light;  ///< frame by frame, from the third on: the light that was added, its mean being 1
  double swing = 0;           ///< largest less smallest of them
  double flicker = 0;         ///< how far a frame is from the mean of its neighbours, median over the frames
  double pixels = 0;          ///< the same pixel by pixel, mean over them
};

/// How far what a look adds at one size is from that at the first size: shares of the latter's largest, and of its RMS.
struct ResolutionPoint {
  std::string preset, settings;
  Size size;
  double worst = 0, rms = 0;
};

struct Report {
  std::string version, device, driver, kind;
  int repeat = 0;
  std::vector<Cell> cells;
  std::vector<GoalResult> goals;
  std::vector<TemporalCurve> temporal;
  std::vector<ResolutionPoint> resolutions;
};

/// Marks the points of the cell that no other beats in both median time and 99.99th percentile of the error. Points
/// without quality are never marked.
void mark_front(Cell& cell);

}  // namespace afterglow::bench
