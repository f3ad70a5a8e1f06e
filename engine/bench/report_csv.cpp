// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "bench/report.h"

namespace afterglow::bench {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string quality_columns(const std::optional<Quality>& quality) {
  if (!quality) return ",,,,";
  const std::string visible = quality->visible ? fmt::format("{:.6g}", *quality->visible) : "";
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.4g},{}", quality->error.worst, quality->error.percentile,
                     quality->error.rms, quality->psnr, visible);
}

}  // namespace

std::string report_csv(const Report& report) {
  std::string out =
      "device,driver,preset,width,height,label,choice,settings,median_ms,lower_quartile_ms,upper_quartile_ms,upload_ms,"
      "read_back_ms,copy_ms,memory_ms,kernels,image_memory,traffic_bytes,unavoidable_bytes,error_max,error_p9999,error_"
      "rms,psnr,visible,front\n";
  for (const auto& cell : report.cells)
    for (const auto& p : cell.points)
      out +=
          fmt::format("{},{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{},{},{},{},{},{}\n",
                      quoted(report.device), quoted(report.driver), quoted(cell.preset), cell.size.width,
                      cell.size.height, quoted(p.label), quoted(p.choice), quoted(p.settings), p.execute.median,
                      p.execute.lower, p.execute.upper, p.upload, p.read_back, cell.copy.median, cell.memory.median,
                      p.kernels, p.image_memory, p.traffic, p.unavoidable, quality_columns(p.quality), p.front ? 1 : 0);
  return out;
}

std::string stability_csv(const Report& report) {
  std::string out = "kind,preset,settings,scene,width,height,radius_px,swing,flicker,pixel_flicker,worst,rms\n";
  for (const auto& c : report.temporal)
    out += fmt::format("shot,{},{},{},{},{},{:g},{:.6g},{:.6g},{:.6g},,\n", quoted(c.preset), quoted(c.settings),
                       quoted(c.scene), c.size.width, c.size.height, c.radius, c.swing, c.flicker, c.pixels);
  for (const auto& p : report.resolutions)
    out += fmt::format("resolution,{},{},lamps,{},{},,,,,{:.6g},{:.6g}\n", quoted(p.preset), quoted(p.settings),
                       p.size.width, p.size.height, p.worst, p.rms);
  return out;
}

}  // namespace afterglow::bench
