// Scanning by std::string_view::find; nothing is copied.
#include "renderer/scene/files/text_scan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marrow {

namespace {
char line_end(std::string_view text) { return text.find('\n') == std::string_view::npos ? '\r' : '\n'; }
}  // namespace

FileProblems::FileProblems(std::string_view text, const std::string& name)
    : text_(text), name_(name), end_(line_end(text)) {}

void FileProblems::add(const char* place, std::size_t length, std::string message, std::string hint) {
  if (is_full()) return;
  const char* line = place;
  while (line != text_.data() && line[-1] != end_) --line;
  found_.push_back(
      {.where = {.file = name_, .line = static_cast<int>(line_of(place)), .column = static_cast<int>(place - line) + 1},
       .message = std::move(message),
       .hint = std::move(hint),
       .length = static_cast<int>(std::clamp<std::size_t>(length, 1, 1000))});
}

void FileProblems::complain(const char* place, std::string message, std::string hint) {
  if (!place) return complain_of_file(std::move(message), std::move(hint));
  add(place, word_at(place).size(), std::move(message), std::move(hint));
}

void FileProblems::complain(std::string_view word, std::string message, std::string hint) {
  add(word.data(), word.size(), std::move(message), std::move(hint));
}

void FileProblems::complain_of_line(const char* place, std::string message, std::string hint) {
  const std::string_view rest = text_.substr(static_cast<std::size_t>(place - text_.data()));
  add(place, std::min(rest.find_first_of("\r\n"), rest.size()), std::move(message), std::move(hint));
}

void FileProblems::complain_of_file(std::string message, std::string hint) {
  if (!is_full()) found_.push_back({.where = {.file = name_}, .message = std::move(message), .hint = std::move(hint)});
}

void FileProblems::give_up(const char* place, std::string message, std::string hint) {
  complain(place, std::move(message), std::move(hint));
  is_over_ = true;
}

Diagnostic FileProblems::warning(std::string message, std::string hint) const {
  return {
      .where = {.file = name_}, .message = std::move(message), .hint = std::move(hint), .severity = Severity::Warning};
}

std::size_t FileProblems::line_of(const char* place) const {
  return static_cast<std::size_t>(std::count(text_.data(), place, end_)) + 1;
}

std::string_view FileProblems::word_at(const char* place) const {
  const std::string_view rest = text_.substr(static_cast<std::size_t>(place - text_.data()));
  return rest.substr(0, rest.find_first_of(" \t\r\n,;"));
}

Diagnostics FileProblems::take() {
  std::ranges::stable_sort(found_, {}, [](const Diagnostic& d) { return std::pair(d.where.line, d.where.column); });
  return std::move(found_);
}

Lines::Lines(std::string_view text) : rest_(text), end_(line_end(text)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find(end_), rest_.size());
  line = rest_.substr(0, end);
  if (line.ends_with('\r')) line.remove_suffix(1);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  return true;
}

std::size_t Lines::count() const { return static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), end_)) + 1; }

std::string_view next_word(std::string_view& line) {
  const char* at = line.data();
  const char* const end = at + line.size();
  while (at != end && is_blank(*at)) ++at;
  const char* stop = at;
  while (stop != end && !is_blank(*stop)) ++stop;
  line = {stop, static_cast<std::size_t>(end - stop)};
  return {at, static_cast<std::size_t>(stop - at)};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<long long> whole_number(double value) {
  constexpr double exact = 9007199254740992.0;  // 2^53: whole numbers up to here have a double
  if (std::floor(value) != value || std::fabs(value) > exact) return std::nullopt;
  return static_cast<long long>(value);
}

std::string quoted_word(std::string_view word) {
  constexpr std::size_t longest = 32;
  std::string text = "`";
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...`" : "`");
}

}  // namespace marrow
