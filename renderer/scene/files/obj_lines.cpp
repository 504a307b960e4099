// Statements first; nodes are made of them at the end, because a line may use a vertex that comes later.
#include "renderer/scene/files/obj_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/obj_statements.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

struct Vertex {
  Vec3d at;
  double radius;      ///< NaN: the file does not say
  const char* place;  ///< of its `v`; null: a mistake was found in it
};
constexpr std::int32_t broken_index = -1;

/// One `l`, or one `p`.
struct Element {
  std::size_t end;  ///< in the list of indices; it begins where the one before ends
  const char* place;
  bool is_line;
};

class ObjReader {
 public:
  ObjReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : text_(text), options_(options), problems_(text, name), list_(options, problems_) {}

  Result<SkeletonFile> read() {
    ObjLines lines(text_);
    for (ObjLine line{}; !problems_.is_full() && lines.next(line);) read_line(line);
    if (elements_.empty() && !problems_.is_full())
      problems_.complain_of_file("the file has no lines and no points",
                                 "a line is: l 1 2 3; triangles are for `mesh:`");
    if (!problems_.is_full()) make_nodes();
    SkeletonFile made;
    if (problems_.none()) made = std::move(list_).finish();
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  void read_line(const ObjLine& line) {
    if (line.keyword == "v" && line.is_first) read_vertex(line.words, line.keyword.data());
    if (line.keyword == "l" || line.keyword == "p") read_element(line.words, line.keyword, line.is_first, line.is_last);
  }

  // x y z, and then nothing, a radius, or a colour. A vertex with mistakes is counted, so that others keep their
  // numbers.
  void read_vertex(std::string_view line, const char* statement) {
    const char* const hint = "a vertex is: v x y z, or: v x y z radius";
    const char* place = statement;
    double value[4] = {0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
    int count = 0;
    std::string_view word = next_word(line);
    for (; !word.empty(); word = next_word(line), ++count) {
      const auto number = finite_number(word);
      if (!number) {
        problems_.complain(word, quoted_word(word) + " is not a finite number", hint);
        place = nullptr;
      }
      if (count < 4 && number) value[count] = *number;
    }
    if (count < 3) {
      problems_.complain(word, fmt::format("the vertex ends after {} numbers, it needs 3", count), hint);
      place = nullptr;
    }
    if (count > 5) value[3] = std::numeric_limits<double>::quiet_NaN();
    vertices_.push_back({{value[0], value[1], value[2]}, value[3], place});
  }

  void read_element(std::string_view line, std::string_view keyword, bool is_first, bool is_last) {
    const char* const start = keyword.data();
    const bool is_line = keyword == "l";
    if (is_first) elements_.push_back({indices_.size(), start, is_line});
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
      indices_.push_back(obj_index(word, vertices_.size(), NodeList::max_nodes, problems_).value_or(broken_index));
    if (indices_.size() > NodeList::max_nodes)
      return problems_.give_up(start, fmt::format("the lines have more than {} nodes", NodeList::max_nodes));
    Element& element = elements_.back();
    const std::size_t begin = elements_.size() > 1 ? elements_[elements_.size() - 2].end : 0;
    element.end = indices_.size();
    if (is_last && element.end - begin < (is_line ? 2u : 1u))
      problems_.complain(start, is_line ? "a line needs two vertices" : "a point needs a vertex");
  }

  void make_nodes() {
    list_.reserve(indices_.size());
    node_of_.assign(vertices_.size(), -1);
    std::size_t i = 0;
    for (const Element& element : elements_) {
      std::int32_t before = -1;
      for (const std::size_t begin = i; i < element.end && !problems_.is_full(); ++i)
        before = add(i, before, element, i - begin);
    }
  }

  // Word by word again, over the lines that the statement goes on to.
  const char* place_of_index(const Element& element, std::size_t number) const {
    Lines lines(text_.substr(static_cast<std::size_t>(element.place - text_.data())));
    bool is_keyword = true;
    for (std::string_view line; lines.next(line);) {
      line = line.substr(0, line.find('#'));
      if (line.ends_with('\\')) line.remove_suffix(1);
      for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
        if (!std::exchange(is_keyword, false) && number-- == 0) return word.data();
    }
    return element.place;
  }

  NodePlaces places_of(const Vertex& vertex) const {
    constexpr std::string_view blanks = " \t\r";
    std::string_view rest = text_.substr(static_cast<std::size_t>(vertex.place - text_.data()));
    const auto next_place = [&] {
      rest.remove_prefix(std::min(rest.find_first_of(blanks), rest.size()));
      rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
      return rest.data();
    };
    NodePlaces places;
    for (const char*& place : places.at) place = next_place();
    if (!std::isnan(vertex.radius)) places.radius = next_place();
    return places;
  }

  // Told once: a file without radii has none at any vertex.
  void ask_for_radius(std::int32_t index, const Vertex& vertex) {
    if (std::exchange(has_asked_for_radius_, true)) return;
    problems_.complain(places_of(vertex).at[0], fmt::format("vertex {} has no radius", index + 1),
                       "give the skeleton a `radius`, or each vertex a fourth number: v x y z radius");
  }

  // A line that begins at a vertex in use goes on from its node; one that passes it gets a node of its own there.
  std::int32_t add(std::size_t i, std::int32_t before, const Element& element, std::size_t number) {
    const std::int32_t index = indices_[i];
    if (index == broken_index) return before;
    if (index >= static_cast<std::int32_t>(vertices_.size())) {
      problems_.complain(place_of_index(element, number),
                         fmt::format("there is no vertex {}: the file has {}", index + 1, vertices_.size()));
      return before;
    }
    const Vertex& vertex = vertices_[static_cast<std::size_t>(index)];
    std::int32_t& node = node_of_[static_cast<std::size_t>(index)];
    if (vertex.place == nullptr) return before;
    if (node >= 0 && ((before < 0 && element.is_line) || !problems_.none())) return node;  // mistakes are told once
    if (std::isnan(vertex.radius) && !options_.radius) {
      ask_for_radius(index, vertex);
      return before;
    }
    node = list_.next_index();
    list_.add(vertex.at, options_.radius.value_or(vertex.radius), element.is_line ? before : -1, places_of(vertex));
    return node;
  }

  std::string_view text_;
  const SkeletonOptions& options_;
  FileProblems problems_;
  NodeList list_;
  std::vector<Vertex> vertices_;
  std::vector<std::int32_t> indices_;
  std::vector<Element> elements_;
  std::vector<std::int32_t> node_of_;
  bool has_asked_for_radius_ = false;
};

}  // namespace

Result<SkeletonFile> read_obj_lines(std::string_view text, const SkeletonOptions& options, const std::string& name) {
  return ObjReader(text, options, name).read();
}

}  // namespace marrow
