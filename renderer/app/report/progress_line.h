// Tells on standard error how far a render is: a bar on a terminal, lines elsewhere, JSON for programs.
#pragma once

#include <string>

#include "renderer/app/command_line/commands.h"
#include "renderer/transport/render.h"

namespace marrow {

class ProgressLine {
 public:
  /// Auto becomes Bar when standard error is a terminal, else Plain.
  explicit ProgressLine(ProgressStyle);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// A step without a measure of its own: "reading", "building".
  void phase(const std::string& name);
  /// May be called as often as one likes: the bar is redrawn four times a second, a plain line comes every five
  /// seconds, a JSON line every second; the last state is always told by Plain and Json.
  void show(const Progress&);
  /// Wipes the bar, so that other text may follow.
  void clear();
  /// A closing line, unless the style is None or Json.
  void close(const std::string& line);

 private:
  ProgressStyle style_;
  double next_s_ = 0;
  bool on_line_ = false;
};

/// "7 s", "1:05", "2:03:04".
std::string clock_text(double seconds);

/// The bar and its figures for a terminal of this width, without line ends.
std::string bar_text(const Progress&, int columns);

}  // namespace marrow
