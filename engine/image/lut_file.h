// SPDX-License-Identifier: MIT
// Look-up tables in files: .cube and the other formats that OpenColorIO reads, taken apart into steps that a shader can
// do, with their numbers in one image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

class FileRecord;  // core/file_record.h

/// One step on a colour c. Its numbers begin at pixel (0, row) of the table.
enum class LutKind {
  none = 0,
  matrix = 1,   ///< 3 pixels (mᵢ₀, mᵢ₁, mᵢ₂, oᵢ): cᵢ' = Σ mᵢⱼ cⱼ + oᵢ
  table1d = 2,  ///< `size` colours, 256 a row, of c in 0…1 (held to it), linear between them, each channel by itself
  table3d = 3,  ///< size³ colours of c in 0…1 (held to it), tetrahedral between them: colour (r, g, b) is at
                ///< (r + size·(b mod 2), row + g + size·⌊b/2⌋)
  range = 4,    ///< 1 pixel (scale, offset, low, high): c' = clamp(scale·c + offset, low, high)
  cdl = 5,      ///< 4 pixels: slope, offset, power, (saturation, 1: held to 0…1 as ASC says; 0: not held)
  power = 6,    ///< 1 pixel (exponents, style of negatives: 0 cut off, 1 mirrored, 2 left as they are)
  table_half = 7,      ///< 65536 colours, 256 a row, by the bits of c as a half float, linear between neighbours
  table3d_linear = 8,  ///< as table3d, linear between the eight entries around c, where the file asks for it (CLF)
};

struct LutStep {
  LutKind kind = LutKind::none;
  int row = 0, size = 0;
  friend bool operator==(const LutStep&, const LutStep&) = default;
};

struct Lut {
  std::vector<LutStep> steps;  ///< in order; at most kMaxLutSteps
  Size size;                   ///< of the table
  std::vector<float> table;    ///< RGBA
};

inline constexpr int kMaxLutSteps = 6;
inline constexpr std::size_t kMostLutBytes = 128u << 20;  ///< of a file: 129³ lines of 50 letters
inline constexpr int kLutRow = 256;                       ///< colours a row of one-dimensional tables

/// Thread-safe. Errors (script, with the file and, for .cube, the line): missing, unknown format, what the file holds
/// is wrong or has no place in steps; io: the module with OpenColorIO is not installed.
/// `record`: see read_file (core/file.h). `correction`: of a file with several (.ccc, .cdl) the one with this id, or by
/// number from 0; empty: the first.
Result<Lut> read_lut(const std::filesystem::path& file, FileRecord* record = nullptr,
                     const std::string& correction = {});

/// Whether what the last step gives always lies in 0…1: it is a table of such entries.
bool gives_unit(const Lut& loaded);

/// Most entries of a table of one dimension, and of a side of one of three (OpenColorIO's own limit).
inline constexpr int kMostLut1d = 65536, kMostLut3d = 129;

/// Who reads a table: a look by itself, or an OpenColorIO configuration, whose tables may be ICC profiles.
enum class TableUse { of_look, of_config };

/// Looks a table through before OpenColorIO reads it, which tries every format whatever the name. Refused: other files
/// that it refers to, XML that could hide such a reference (a document type, UTF-16), sizes that take memory before a
/// line is read; and of a .cube whatever check_cube refuses. Errors: script, with the file.
Result<void> check_table(const std::string& text, const std::filesystem::path& path, TableUse use);

/// Looks a .cube through before OpenColorIO reads it, which says less about what is wrong and takes memory for whatever
/// size a file claims. Errors: script, at the line.
Result<void> check_cube(const std::string& text, const std::string& file);

}  // namespace afterglow
