// SPDX-License-Identifier: MIT
#include "apps/console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/printable.h"

namespace afterglow {
namespace {

constexpr std::string_view kRed = "\x1b[1;31m", kBold = "\x1b[1m", kPlain = "\x1b[0m";
constexpr std::string_view kEraseLine = "\r\x1b[K";

bool terminal_has_colors() {
  const char* term = std::getenv("TERM");
  return std::getenv("NO_COLOR") == nullptr && term != nullptr && std::string_view(term) != "dumb";
}

/// Messages that nobody reads stop no work.
void put(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// As much of a line as stderr's terminal has room for, so that the line stays one.
std::string_view fitting(std::string_view line) {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return line;
  std::size_t room = size.ws_col - 1u;  // in its last column some terminals begin the next line
  for (std::size_t i = 0; i < line.size(); ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xC0) == 0x80) continue;
    if (room-- == 0) return line.substr(0, i);
  }
  return line;
}

std::string clock_text(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{:02}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Console::Console()
    : diagnostics_([this](Severity severity, const std::string& text) {
        severity == Severity::warning                   ? warning(text)
        : severity == Severity::printed&& prints_shown_ ? remark(text)
                                                        : note(text);
      }) {
  configure(Verbosity::normal, true);
}

Console::~Console() { end_progress(); }

void Console::configure(Verbosity verbosity, bool color) {
  std::lock_guard lock(mutex_);
  verbosity_ = verbosity;
  terminal_ = isatty(STDERR_FILENO) != 0;
  color_ = color && terminal_ && terminal_has_colors();
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_st>(color_ ? spdlog::color_mode::always
                                                                           : spdlog::color_mode::never);
  log_ = std::make_shared<spdlog::logger>("afterglow", std::move(sink));
  log_->set_pattern("%^%l%$: %v");
  log_->set_level(verbosity == Verbosity::quiet     ? spdlog::level::off
                  : verbosity == Verbosity::verbose ? spdlog::level::info
                                                    : spdlog::level::warn);
}

void Console::error(const Error& error) {
  std::lock_guard lock(mutex_);
  erase_progress();
  std::string text = error.text();
  if (color_) {
    if (const auto at = text.find("error: "); at != std::string::npos) {
      text = fmt::format("{}{}{}{}error:{}{}", kBold, text.substr(0, at), kPlain, kRed, kPlain, text.substr(at + 6));
    }
  }
  put(text + "\n");
}

void Console::warning(const std::string& text) {
  ++warnings_;
  std::lock_guard lock(mutex_);
  erase_progress();
  log_->warn("{}", text);
}

void Console::note(const std::string& text) {
  std::lock_guard lock(mutex_);
  erase_progress();
  log_->info("{}", text);
}

void Console::remark(const std::string& text) {
  std::lock_guard lock(mutex_);
  if (verbosity_ == Verbosity::quiet) return;
  erase_progress();
  put("note: " + printable(text) + "\n");
}

void Console::progress(std::size_t done, std::size_t total, const std::string& label, double seconds) {
  std::lock_guard lock(mutex_);
  if (!terminal_ || verbosity_ == Verbosity::quiet || total == 0) return;
  constexpr std::size_t kWidth = 24;
  const std::size_t filled = done * kWidth / total;
  const double left = done > 0 ? seconds / static_cast<double>(done) * static_cast<double>(total - done) : 0;
  const std::string line =
      fmt::format("[{}{}] {}/{}  {}{}", std::string(filled, '='), std::string(kWidth - filled, ' '), done, total, label,
                  done > 0 ? fmt::format("  {} left", clock_text(left)) : "");
  put(fmt::format("{}{}", kEraseLine, fitting(line)));
  progress_shown_ = true;
}

void Console::end_progress() {
  std::lock_guard lock(mutex_);
  erase_progress();
}

void Console::erase_progress() {
  if (!progress_shown_) return;
  put(kEraseLine);
  progress_shown_ = false;
}

}  // namespace afterglow
