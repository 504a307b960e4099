// Texts by name, and the printing of diagnostics with the lines they speak of.
#include "renderer/scene/source_cache.h"

#include <algorithm>
#include <map>
#include <utility>

#include "renderer/scene/utf8.h"

namespace marrow {

std::uint32_t SourceCache::add(std::string name, std::string text) {
  sources_.push_back({std::move(name), std::move(text)});
  return static_cast<std::uint32_t>(sources_.size() - 1);
}

SourceLocation SourceCache::location(const Place& place) const {
  if (place.file >= sources_.size()) return {};
  return {.file = name(place.file), .line = place.line, .column = place.column};
}

std::string_view SourceCache::text(std::string_view name) const {
  for (auto source = sources_.rbegin(); source != sources_.rend(); ++source)
    if (source->name == name) return source->text;
  return {};
}

std::string render_all(const Diagnostics& diagnostics, const SourceCache& sources) {
  std::string out;
  std::map<std::string, std::string_view> texts;  // those that can be shown
  for (const Diagnostic& d : diagnostics) {
    const auto [text, is_new] = texts.emplace(d.where.file, std::string_view{});
    if (is_new && !first_invalid_utf8(sources.text(d.where.file))) text->second = sources.text(d.where.file);
    out += render(d, text->second);
  }
  const auto errors = std::count_if(diagnostics.begin(), diagnostics.end(),
                                    [](const Diagnostic& d) { return d.severity == Severity::Error; });
  if (errors > 0) out += std::to_string(errors) + (errors == 1 ? " error\n" : " errors\n");
  return out;
}

}  // namespace marrow
