// Two passes: lines to nodes, then parents from ids to indices.
#include "renderer/scene/files/swc.h"

#include <array>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/parents.h"
#include "renderer/scene/files/text_scan.h"

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
    if (nodes_.empty() && problems_.none())
      problems_.complain_of_file("the file has no nodes", "a line is: id type x y z radius parent");
    if (problems_.none()) list_.parents() = parent_indices(nodes_, problems_);
    SkeletonFile made;
    if (problems_.none()) made = std::move(list_).finish();
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  enum Column { Id, Type, X, Y, Z, Radius, Parent, Columns };

  void read_line(std::string_view line) {
    const char* const start = line.data();
    line = line.substr(0, line.find('#'));
    std::array<double, Columns> value{};
    std::size_t column = 0;
    for (; column < Columns; ++column) {
      const std::string_view word = next_word(line);
      if (word.empty()) break;
      const auto number = finite_number(word);
      if (!number)
        return problems_.complain(word.data(), quoted_word(word) + " is not a finite number",
                                  "a line is: id type x y z radius parent");
      value[column] = *number;
    }
    if (column == 0) return;
    if (column < Columns)
      return problems_.complain(start, fmt::format("the line has {} columns, it needs 7", column),
                                "a line is: id type x y z radius parent");
    add(value, start);
  }

  void add(const std::array<double, Columns>& value, const char* place) {
    for (const Column c : {Id, Type, Parent})
      if (!whole_number(value[c]))
        return problems_.complain(place, fmt::format("the {} is not a whole number", c == Id     ? "id"
                                                                                     : c == Type ? "type"
                                                                                                 : "parent"));
    nodes_.push_back({*whole_number(value[Id]), *whole_number(value[Parent]), place});
    list_.add({value[X], value[Y], value[Z]}, value[Radius], place);
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
