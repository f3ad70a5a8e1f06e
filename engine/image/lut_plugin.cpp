// OpenColorIO's side of read_lut: a file becomes a chain of its transforms, each taken apart into a step.
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/exception.h"
#include "image/lut_file.h"

namespace OCIO = OCIO_NAMESPACE;

namespace afterglow {
namespace {

/// A chain that cannot be taken apart, and why.
struct Unsupported {
  std::string what;
};

constexpr float kHuge = std::numeric_limits<float>::max();

class Taker {
 public:
  Lut take(const OCIO::GroupTransform& group) {
    add_group(group);
    if (lut_.steps.size() > static_cast<std::size_t>(kMaxLutSteps))
      throw Unsupported{fmt::format("has {} steps; at most {} are possible", lut_.steps.size(), kMaxLutSteps)};
    finish();
    return std::move(lut_);
  }

 private:
  using Row = std::vector<std::array<float, 4>>;

  void add_group(const OCIO::GroupTransform& group) {
    for (int i = 0; i < group.getNumTransforms(); ++i) add(*group.getTransform(i));
  }

  void add(const OCIO::Transform& transform) {
    if (const auto* group = dynamic_cast<const OCIO::GroupTransform*>(&transform)) return add_group(*group);
    if (const auto* matrix = dynamic_cast<const OCIO::MatrixTransform*>(&transform)) return add_matrix(*matrix);
    if (const auto* range = dynamic_cast<const OCIO::RangeTransform*>(&transform)) return add_range(*range);
    if (const auto* table = dynamic_cast<const OCIO::Lut1DTransform*>(&transform)) return add_table(*table);
    if (const auto* table = dynamic_cast<const OCIO::Lut3DTransform*>(&transform)) return add_table(*table);
    if (const auto* cdl = dynamic_cast<const OCIO::CDLTransform*>(&transform)) return add_cdl(*cdl);
    if (const auto* power = dynamic_cast<const OCIO::ExponentTransform*>(&transform)) return add_power(*power);
    throw Unsupported{"holds a step that is neither a table, a matrix, a range, a CDL nor an exponent"};
  }

  static void forward(const OCIO::Transform& transform, const char* what) {
    if (transform.getDirection() != OCIO::TRANSFORM_DIR_FORWARD)
      throw Unsupported{fmt::format("holds {} that is to be inverted", what)};
  }

  void add_matrix(const OCIO::MatrixTransform& matrix) {
    forward(matrix, "a matrix");
    std::array<double, 16> m{};
    std::array<double, 4> offset{};
    matrix.getMatrix(m.data());
    matrix.getOffset(offset.data());
    Row row;
    for (std::size_t i = 0; i < 3; ++i)
      row.push_back({static_cast<float>(m[4 * i]), static_cast<float>(m[4 * i + 1]), static_cast<float>(m[4 * i + 2]),
                     static_cast<float>(offset[i])});
    begin(LutKind::matrix, 0, 1);
    put(row);
  }

  void add_range(const OCIO::RangeTransform& range) {
    forward(range, "a range");
    const bool low = range.hasMinInValue() && range.hasMinOutValue();
    const bool high = range.hasMaxInValue() && range.hasMaxOutValue();
    double scale = 1, offset = 0;
    if (low && high && range.getMaxInValue() > range.getMinInValue())
      scale = (range.getMaxOutValue() - range.getMinOutValue()) / (range.getMaxInValue() - range.getMinInValue());
    if (low)
      offset = range.getMinOutValue() - scale * range.getMinInValue();
    else if (high)
      offset = range.getMaxOutValue() - scale * range.getMaxInValue();
    const bool clamps = range.getStyle() == OCIO::RANGE_CLAMP;
    begin(LutKind::range, 0, 1);
    put({{static_cast<float>(scale), static_cast<float>(offset),
          clamps && low ? static_cast<float>(range.getMinOutValue()) : -kHuge,
          clamps && high ? static_cast<float>(range.getMaxOutValue()) : kHuge}});
  }

  void add_table(const OCIO::Lut1DTransform& table) {
    forward(table, "a table");
    if (table.getHueAdjust() != OCIO::HUE_NONE) throw Unsupported{"holds a table with hue adjustment"};
    const auto length = static_cast<int>(table.getLength());
    begin(table.getInputHalfDomain() ? LutKind::table_half : LutKind::table1d, length,
          (length + kLutRow - 1) / kLutRow);
    for (int i = 0; i < length; ++i) {
      float r = 0, g = 0, b = 0;
      table.getValue(static_cast<unsigned long>(i), r, g, b);
      put(i % kLutRow, i / kLutRow, {r, g, b, 1});
    }
  }

  void add_table(const OCIO::Lut3DTransform& table) {
    forward(table, "a table");
    const auto size = static_cast<int>(table.getGridSize());
    begin(LutKind::table3d, size, size * ((size + 1) / 2));
    for (int r = 0; r < size; ++r)
      for (int g = 0; g < size; ++g)
        for (int b = 0; b < size; ++b) {
          float red = 0, green = 0, blue = 0;
          table.getValue(static_cast<unsigned long>(r), static_cast<unsigned long>(g), static_cast<unsigned long>(b),
                         red, green, blue);
          put(r + size * (b & 1), g + size * (b >> 1), {red, green, blue, 1});
        }
  }

  void add_cdl(const OCIO::CDLTransform& cdl) {
    forward(cdl, "a CDL");
    std::array<double, 3> v{};
    Row row;
    const auto take = [&] {
      row.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0});
    };
    cdl.getSlope(v.data());
    take();
    cdl.getOffset(v.data());
    take();
    cdl.getPower(v.data());
    take();
    row.push_back({static_cast<float>(cdl.getSat()), cdl.getStyle() == OCIO::CDL_ASC ? 1.0F : 0.0F, 0, 0});
    begin(LutKind::cdl, 0, 1);
    put(row);
  }

  void add_power(const OCIO::ExponentTransform& power) {
    double v[4] = {1, 1, 1, 1};  // NOLINT: OpenColorIO takes an array
    power.getValue(v);
    if (power.getDirection() == OCIO::TRANSFORM_DIR_INVERSE)
      for (double& x : v) x = 1 / x;
    float style = 0;
    if (power.getNegativeStyle() == OCIO::NEGATIVE_MIRROR) style = 1;
    if (power.getNegativeStyle() == OCIO::NEGATIVE_PASS_THRU) style = 2;
    begin(LutKind::power, 0, 1);
    put({{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), style}});
  }

  // ---- the table

  void begin(LutKind kind, int size, int rows) {
    first_ = rows_;
    rows_ += rows;
    if (rows_ > 16384) throw Unsupported{"holds more numbers than an image can have"};
    lut_.steps.push_back({kind, first_, size});
  }
  void put(int x, int y, const std::array<float, 4>& v) { placed_.push_back({x, first_ + y, v}); }
  void put(const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) put(static_cast<int>(i), 0, row[i]);
  }
  void finish() {
    int width = 4;
    for (const auto& p : placed_) width = std::max(width, p.x + 1);
    lut_.size = {width, std::max(rows_, 1)};
    lut_.table.assign(static_cast<std::size_t>(lut_.size.area()) * 4, 0.0F);
    for (const auto& p : placed_) {
      for (const float v : p.value)
        if (!std::isfinite(v)) throw Unsupported{"holds a number that is not finite"};
      std::copy(p.value.begin(), p.value.end(),
                lut_.table.begin() + 4 * (static_cast<std::ptrdiff_t>(p.y) * width + p.x));
    }
  }

  struct Placed {
    int x, y;
    std::array<float, 4> value;
  };
  Lut lut_;
  std::vector<Placed> placed_;
  int rows_ = 0, first_ = 0;
};

/// OpenColorIO's message in one line, with the line of the file where it names one.
Error error_of(const std::string& file, std::string message) {
  int line = 0;
  if (const auto at = message.find("line"); at != std::string::npos)
    if (const auto digit = message.find_first_of("0123456789", at); digit != std::string::npos && digit < at + 8)
      line = std::atoi(message.c_str() + digit);
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  if (message.size() > 300) message.resize(300);
  return {ErrorKind::script, "OpenColorIO cannot read it: " + message, file, line};
}

Result<Lut> read(const std::filesystem::path& file) {
  static std::mutex mutex;  // its cache of files is one for all
  const std::lock_guard lock(mutex);
  OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);  // what it says comes back as an error
  try {
    OCIO::ClearAllCaches();  // it knows files by their names: one that was edited would stay as it was
    const auto config = OCIO::Config::CreateRaw();
    const auto transform = OCIO::FileTransform::Create();
    transform->setSrc(std::filesystem::absolute(file).c_str());
    transform->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
    transform->setCCCId("0");  // of a list of corrections, the first
    return Taker().take(*config->getProcessor(transform)->createGroupTransform());
  } catch (const Unsupported& why) {
    return Error{ErrorKind::script, why.what, file.string()};
  } catch (const std::exception& error) {
    return error_of(file.string(), exception_text(error));
  }
}

std::vector<std::string> extensions() {
  // No tables: profiles of devices, and collections that name further files.
  static constexpr std::array kOthers{"icc", "icm", "pf", "ctf", "ccc", "look"};
  std::vector<std::string> all;
  for (int i = 0; i < OCIO::FileTransform::GetNumFormats(); ++i) {
    const std::string extension = OCIO::FileTransform::GetFormatExtensionByIndex(i);
    if (std::find(kOthers.begin(), kOthers.end(), extension) == kOthers.end()) all.push_back(extension);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace
}  // namespace afterglow

extern "C" __attribute__((visibility("default"))) const afterglow::LutModule* afterglow_lut_module() {
  static constexpr afterglow::LutModule module{&afterglow::read, &afterglow::extensions};
  return &module;
}
