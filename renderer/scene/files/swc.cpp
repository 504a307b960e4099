// Two passes: lines to nodes, then parents from ids to indices; the second also after mistakes of the first.
#include "renderer/scene/files/swc.h"

#include <array>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/parents.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

class SwcReader {
 public:
  SwcReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : text_(text), problems_(text, name), list_(options, problems_) {}

  Result<SkeletonFile> read() {
    Lines lines(text_);
    list_.reserve(lines.count());
    nodes_.reserve(lines.count());
    for (std::string_view line; !problems_.is_full() && lines.next(line);) read_line(line);
    if (nodes_.empty() && problems_.none()) problems_.complain_of_file("the file has no nodes", form);
    const bool are_lines_good = problems_.none();
    if (!problems_.is_full()) list_.parents() = parent_indices(nodes_, problems_);
    SkeletonFile made;
    if (are_lines_good) made = std::move(list_).finish();
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  enum Column : std::size_t { Id, Type, X, Y, Z, Radius, Parent, Columns };
  static constexpr const char* form = "a line is: id type x y z radius parent";
  struct Row {
    std::array<std::string_view, Columns> word;
    std::array<std::optional<double>, Columns> number;
  };

  void read_line(std::string_view line) {
    line = line.substr(0, line.find('#'));
    Row row;
    std::size_t count = 0;
    bool has_number = false;
    std::string_view word = next_word(line);
    for (; count < Columns && !word.empty(); word = next_word(line), ++count) {
      row.word[count] = word;
      row.number[count] = finite_number(word);
      has_number = has_number || row.number[count];
    }
    if (count == 0) return;
    for (std::size_t c = 0; c < count; ++c)
      if (!row.number[c]) {
        problems_.complain(row.word[c], quoted_word(row.word[c]) + " is not a finite number", form);
        if (!has_number) return;  // a line of words is one mistake
      }
    if (count < Columns)
      problems_.complain(word, fmt::format("the line ends after {} columns, it needs 7", count), form);
    add(row);
  }

  // A node with mistakes keeps its id, so that what names it is not a second mistake.
  void add(const Row& row) {
    const auto id = whole(row, Id, "id"), parent = whole(row, Parent, "parent");
    whole(row, Type, "type");
    if (id)
      nodes_.push_back({*id, parent.value_or(NamedNode::no_parent), row.word[Id].data(), row.word[Parent].data()});
    const auto number = [&](Column c) { return row.number[c].value_or(0); };
    const auto place = [&](Column c) { return row.word[c].data(); };
    list_.add({number(X), number(Y), number(Z)}, number(Radius),
              NodePlaces{{place(X), place(Y), place(Z)}, place(Radius)});
  }

  std::optional<long long> whole(const Row& row, Column column, const char* name) {
    if (!row.number[column]) return std::nullopt;
    const auto value = whole_number(*row.number[column]);
    if (!value)
      problems_.complain(row.word[column],
                         fmt::format("the {} {} is not a whole number", name, quoted_word(row.word[column])), form);
    return value;
  }

  std::string_view text_;
  FileProblems problems_;
  NodeList list_;
  std::vector<NamedNode> nodes_;
};

}  // namespace

Result<SkeletonFile> read_swc(std::string_view text, const SkeletonOptions& options, const std::string& name) {
  return SwcReader(text, options, name).read();
}

}  // namespace marrow
