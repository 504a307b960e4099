// The header says what follows: elements, each with its properties. Values are taken one by one, from words or bytes.
#include "renderer/scene/files/ply.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "renderer/scene/files/bytes.h"
#include "renderer/scene/files/mesh_builder.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

struct Type {
  enum Kind { Signed, Unsigned, Real } kind;
  std::size_t bytes;
};

std::optional<Type> type_of(std::string_view word) {
  struct Named {
    std::string_view name, sized;
    Type type;
  };
  static constexpr std::array<Named, 8> types{{{"char", "int8", {Type::Signed, 1}},
                                               {"uchar", "uint8", {Type::Unsigned, 1}},
                                               {"short", "int16", {Type::Signed, 2}},
                                               {"ushort", "uint16", {Type::Unsigned, 2}},
                                               {"int", "int32", {Type::Signed, 4}},
                                               {"uint", "uint32", {Type::Unsigned, 4}},
                                               {"float", "float32", {Type::Real, 4}},
                                               {"double", "float64", {Type::Real, 8}}}};
  for (const Named& known : types)
    if (word == known.name || word == known.sized) return known.type;
  return std::nullopt;
}

struct Property {
  std::string_view name;
  Type type;
  std::optional<Type> count;  ///< of a list
};

struct Element {
  std::string_view name;
  std::uint64_t count;
  std::vector<Property> properties;
};

enum class Format { Ascii, LittleEndian, BigEndian };

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< in bytes
};

class HeaderReader {
 public:
  HeaderReader(std::string_view text, FileProblems& problems) : text_(text), problems_(problems) {}

  // Something only without mistakes.
  std::optional<Header> read() {
    Lines lines(text_);
    std::string_view line;
    if (!lines.next(line) || trimmed(line) != "ply") return give_up("not a PLY file: its first line is not `ply`");
    while (!problems_.is_full()) {
      if (!lines.next(line)) return give_up("the header of the PLY file has no end", "it ends in a line: end_header");
      if (trimmed(line) == "end_header") break;
      read_line(line);
    }
    if (problems_.none() && !has_format_) give_up("the header of the PLY file names no format");
    if (!problems_.none()) return std::nullopt;
    header_.size = static_cast<std::size_t>(line.data() + line.size() - text_.data());
    for (const char end : {'\r', '\n'})
      if (header_.size < text_.size() && text_[header_.size] == end) ++header_.size;
    return header_;
  }

 private:
  std::nullopt_t give_up(std::string message, std::string hint = {}) {
    problems_.complain_of_file(std::move(message), std::move(hint));
    return std::nullopt;
  }

  void read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "format") read_format(next_word(line));
    else if (keyword == "element") read_element(line);
    else if (keyword == "property") read_property(line);
    else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty())
      problems_.complain(keyword, quoted_word(keyword) + " is not known to the header of a PLY file",
                         "lines are: format, element, property, comment, obj_info, end_header");
  }

  void read_format(std::string_view word) {
    has_format_ = true;
    if (word == "ascii") header_.format = Format::Ascii;
    else if (word == "binary_little_endian") header_.format = Format::LittleEndian;
    else if (word == "binary_big_endian") header_.format = Format::BigEndian;
    else
      problems_.complain(word, quoted_word(word) + " is not a format",
                         "formats are: ascii, binary_little_endian, binary_big_endian");
  }

  void read_element(std::string_view line) {
    const std::string_view name = next_word(line), count = next_word(line);
    const auto number = finite_number(count);
    const auto whole = number ? whole_number(*number) : std::nullopt;
    if (!whole || *whole < 0)
      return problems_.complain(count, quoted_word(count) + " is not a number of elements",
                                "a line is: element vertex 12");
    header_.elements.push_back({name, static_cast<std::uint64_t>(*whole), {}});
  }

  void read_property(std::string_view line) {
    Property made{};
    std::string_view word = next_word(line);
    if (word == "list") {
      const std::string_view count = next_word(line);
      made.count = type_of(count);
      if (!made.count || made.count->kind == Type::Real) return complain_of_type(count);
      word = next_word(line);
    }
    const auto type = type_of(word);
    if (!type) return complain_of_type(word);
    made.type = *type;
    made.name = next_word(line);
    if (header_.elements.empty()) return problems_.complain(word, "a property before the first element");
    header_.elements.back().properties.push_back(made);
  }

  void complain_of_type(std::string_view word) {
    problems_.complain(word, quoted_word(word) + " is not a type",
                       "a line is: property float x, or: property list uchar int vertex_indices");
  }

  std::string_view text_;
  FileProblems& problems_;
  Header header_;
  bool has_format_ = false;
};

// What follows the header, value by value.
class Values {
 public:
  Values(std::string_view body, Format format)
      : format_(format), body_(body), bytes_(body, format == Format::BigEndian) {}

  // Nothing at the end of the file, or after a word that is no number.
  std::optional<double> next(Type type) { return format_ == Format::Ascii ? next_number() : next_bytes(type); }
  // Passes over a value, which may be any word; false at the end of the file.
  bool skip(Type type) {
    const bool is_there = next(type).has_value();
    return is_there || !word_.empty();
  }
  // Where the last value stands; null in binary files.
  const char* place() const { return word_.data(); }
  std::string_view word() const { return word_; }

 private:
  std::optional<double> next_number() {
    constexpr std::string_view blanks = " \t\r\n";
    at_ = std::min(body_.find_first_not_of(blanks, at_), body_.size());
    const std::size_t end = std::min(body_.find_first_of(blanks, at_), body_.size());
    word_ = body_.substr(at_, end - at_);
    at_ = end;
    return finite_number(word_);
  }

  std::optional<double> next_bytes(Type type) {
    if (body_.size() - at_ < type.bytes) return std::nullopt;
    const std::size_t at = at_;
    at_ += type.bytes;
    if (type.kind == Type::Real) return type.bytes == 4 ? bytes_.real32(at) : bytes_.real64(at);
    const auto whole = static_cast<std::int64_t>(bytes_.whole(at, type.bytes));
    const std::int64_t half = std::int64_t{1} << (8 * type.bytes - 1);
    return static_cast<double>(type.kind == Type::Signed && whole >= half ? whole - 2 * half : whole);
  }

  Format format_;
  std::string_view body_, word_;
  Bytes bytes_;
  std::size_t at_ = 0;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& name) : bytes_(bytes), mesh_(bytes, name, 0) {}

  Result<MeshShape> read() && {
    FileProblems& problems = mesh_.problems();
    const auto header = HeaderReader(bytes_, problems).read();
    if (!header) return problems.take();
    Values values(bytes_.substr(header->size), header->format);
    for (const Element& element : header->elements) {
      if (element.name == "vertex" && !has_position(element))
        problems.complain_of_file("the vertices have no property x, y or z");
      // What has no properties takes no bytes, however many it is.
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count && problems.none(); ++i)
        if (!read_one(element, values)) complain_of_value(element, i, values);
    }
    return std::move(mesh_).finish();
  }

 private:
  static bool has_position(const Element& element) {
    return std::ranges::all_of(std::array{"x", "y", "z"}, [&](std::string_view name) {
      return std::ranges::any_of(element.properties,
                                 [&](const Property& p) { return p.name == name && !p.count.has_value(); });
    });
  }

  // False when a value is missing or wrong.
  bool read_one(const Element& element, Values& values) {
    Vec3d at{};
    const char* place = nullptr;
    for (const Property& property : element.properties) {
      if (property.count) {
        if (!read_list(element, property, values)) return false;
        continue;
      }
      const std::size_t axis = property.name.size() == 1 ? std::string_view("xyz").find(property.name) : 3;
      if (axis > 2) {
        if (!values.skip(property.type)) return false;
        continue;
      }
      const auto value = values.next(property.type);
      if (!value) return false;
      at[axis] = *value;
      if (place == nullptr) place = values.place();
    }
    if (element.name == "vertex") mesh_.add_vertex(at, place);
    return true;
  }

  bool read_list(const Element& element, const Property& property, Values& values) {
    const bool is_face =
        element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
    const auto count = values.next(*property.count);
    const auto whole = count ? whole_number(*count) : std::nullopt;
    if (!whole || *whole < 0) return false;
    const char* const place = values.place();
    for (long long i = 0; i < *whole; ++i) {
      if (!is_face) {
        if (!values.skip(property.type)) return false;
        continue;
      }
      const auto value = values.next(property.type);
      const auto vertex = value ? whole_number(*value) : std::nullopt;
      if (!vertex || *vertex < 0 || *vertex > UINT32_MAX) return false;
      mesh_.add_corner(static_cast<std::uint32_t>(*vertex), values.place());
    }
    if (is_face) mesh_.end_face(place);
    return true;
  }

  void complain_of_value(const Element& element, std::uint64_t i, const Values& values) {
    const std::string where = fmt::format("{} {} of {}", quoted_word(element.name), i + 1, element.count);
    const std::string_view word = values.word();
    if (!word.empty()) return mesh_.problems().complain(word, quoted_word(word) + " is no value of " + where);
    mesh_.problems().complain_of_file("the file ends, or has a wrong value, in " + where,
                                      "it was cut, or is not what its header says");
  }

  std::string_view bytes_;
  MeshBuilder mesh_;
};

}  // namespace

Result<MeshShape> read_ply(std::string_view bytes, const std::string& name) { return PlyReader(bytes, name).read(); }

}  // namespace marrow
