// One source of numbers, three ways to tell them.
#include "renderer/app/report/progress_line.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "renderer/app/text/print.h"

namespace marrow {
namespace {

constexpr const char* wipe = "\r\033[K";

// Of the samples, or of the time when that ends first.
double share(const Progress& p) {
  const double done = p.total == 0 ? 0 : static_cast<double>(p.done) / static_cast<double>(p.total);
  return std::max(done, std::min(p.elapsed_s / p.limit_s, 1.0));
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

double interval_s(ProgressStyle style) {
  return style == ProgressStyle::Bar ? 0.25 : style == ProgressStyle::Json ? 1 : 5;
}

std::string plain_text(const Progress& p) {
  return fmt::format("render {:.1f} %, {} spp, elapsed {}, left {}", 100 * share(p), p.samples_per_pixel,
                     clock_text(p.elapsed_s), clock_text(p.left_s));
}

std::string json_text(const Progress& p) {
  return fmt::format(
      R"({{"phase": "render", "done": {}, "total": {}, "elapsed_s": {:.3f}, "eta_s": {:.3f}, "spp_min": {}}})", p.done,
      p.total, p.elapsed_s, p.left_s, p.samples_per_pixel);
}

}  // namespace

std::string clock_text(double seconds) {
  const auto s = static_cast<long long>(std::floor(std::clamp(seconds, 0.0, 1e9) + 0.5));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bar_text(const Progress& p, int columns) {
  const std::string figures = fmt::format(" {:3.0f} %  {} spp  {} elapsed, {} left", std::floor(100 * share(p)),
                                          p.samples_per_pixel, clock_text(p.elapsed_s), clock_text(p.left_s));
  // Brackets, and one column that stays free so that the terminal does not wrap.
  const int room = std::min(columns - static_cast<int>(figures.size()) - 3, 40);
  if (room < 5) return figures.substr(1, static_cast<std::size_t>(std::max(columns - 1, 0)));
  const auto full = static_cast<std::size_t>(share(p) * room);
  return '[' + std::string(full, '#') + std::string(static_cast<std::size_t>(room) - full, '.') + ']' + figures;
}

ProgressLine::ProgressLine(ProgressStyle style) : style_(style) {
  if (style_ == ProgressStyle::Auto) style_ = isatty(STDERR_FILENO) ? ProgressStyle::Bar : ProgressStyle::Plain;
  if (style_ == ProgressStyle::Plain) next_s_ = interval_s(style_);
}

void ProgressLine::clear() {
  if (on_line_) complain(wipe);
  on_line_ = false;
}

void ProgressLine::phase(const std::string& name) {
  if (style_ == ProgressStyle::Json) complain(fmt::format("{{\"phase\": \"{}\"}}\n", name));
  if (style_ != ProgressStyle::Bar) return;
  complain(fmt::format("{}{} ...", wipe, name));
  on_line_ = true;
}

void ProgressLine::show(const Progress& p) {
  const bool last = p.done == p.total && style_ != ProgressStyle::Bar;
  if (style_ == ProgressStyle::None || (p.elapsed_s < next_s_ && !last)) return;
  next_s_ = p.elapsed_s + interval_s(style_);
  if (style_ == ProgressStyle::Bar) complain(fmt::format("{}{}", wipe, bar_text(p, terminal_columns())));
  else complain(fmt::format("{}\n", style_ == ProgressStyle::Json ? json_text(p) : plain_text(p)));
  on_line_ = style_ == ProgressStyle::Bar;
}

void ProgressLine::close(const std::string& line) {
  clear();
  if (style_ != ProgressStyle::None && style_ != ProgressStyle::Json) complain(line + '\n');
}

}  // namespace marrow
