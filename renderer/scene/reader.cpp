// The wording of mistakes, each once.
#include "renderer/scene/reader.h"

#include <utility>

#include "renderer/scene/suggestion.h"

namespace marrow {

void Reader::error(const Place& at, std::string message, std::string hint, std::size_t length) {
  problems.push_back({.where = sources.location(at),
                      .message = std::move(message),
                      .hint = std::move(hint),
                      .length = static_cast<int>(length)});
}

std::nullopt_t Reader::wrong(const Value& value, const std::string& words, std::string hint) {
  if (value.kind == Value::Kind::Broken) return std::nullopt;
  const std::size_t quotes = value.kind == Value::Kind::Quoted ? 2 : 0;
  error(value.place, subject + " must be " + words + ", found " + describe(value), std::move(hint),
        value.text.size() + quotes);
  return std::nullopt;
}

std::nullopt_t Reader::unknown(const std::string& what, const std::string& name, const Place& at,
                               const std::vector<std::string>& known) {
  error(at, "unknown " + what + " `" + name + "`", suggest(name, known), name.size());
  return std::nullopt;
}

std::nullopt_t Reader::not_yet(const std::string& name, const Place& at) {
  error(at, "`" + name + "` is a name of the format that this version does not render yet", "", name.size());
  return std::nullopt;
}

std::string item_of(const std::string& list, std::size_t i) {
  const bool is_quoted = list.ends_with('`');
  const std::string name = is_quoted ? list.substr(0, list.size() - 1) : list + " ";
  return name + "[" + std::to_string(i) + (is_quoted ? "]`" : "]");
}

bool Reader::spend_nodes(std::size_t count, const Place& at) {
  if (count <= nodes_left) return nodes_left -= count, true;
  // Said once: everything after it would fail in the same way. (What is left may have been nothing before.)
  if (!std::exchange(said_too_large_, true))
    error(at, "the fields grow too large here", "place fewer copies with `use:`; large skeletons belong in files");
  nodes_left = 0;
  return false;
}

std::filesystem::path Reader::resolve(const std::string& name, const Place& at) const {
  const std::filesystem::path source = sources.name(at.file);
  const std::filesystem::path folder = source == "-D" ? folder_ : source.parent_path();
  return (folder / name).lexically_normal();
}

std::optional<InputFile> Reader::open(const std::filesystem::path& path, const Place& at) {
  auto file = files.read(path);
  if (file) return std::move(*file);
  for (const Diagnostic& d : file.why()) error(at, d.message, d.hint);
  return std::nullopt;
}

void Reader::report_file(const std::filesystem::path& path, std::string text, const Diagnostics& found) {
  if (found.empty()) return;
  sources.add(path.string(), std::move(text));
  for (const Diagnostic& d : found) (d.severity == Severity::Error ? problems : warnings).push_back(d);
}

}  // namespace marrow
