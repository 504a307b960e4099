// The first row decides the columns; the others become nodes one by one.
#include "renderer/scene/files/csv.h"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "renderer/scene/files/ascii.h"
#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/parents.h"
#include "renderer/scene/files/table_rows.h"
#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

enum Column : std::size_t { X, Y, Z, Radius, Strand, Id, Parent, Columns };
constexpr std::array<const char*, Columns> column_names = {"x", "y", "z", "radius", "strand", "id", "parent"};

class CsvReader {
 public:
  CsvReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : options_(options), problems_(text, name), rows_(text, problems_), list_(options, problems_) {
    const CsvColumns& c = options.columns;
    wanted_ = {c.x, c.y, c.z, c.radius, c.strand, c.id, c.parent};
  }

  Result<SkeletonFile> read() {
    std::vector<TableField> row;
    if (!rows_.next(row)) problems_.complain_of_file("the table is empty");
    else find_columns(row);
    if (problems_.none()) {
      list_.reserve(rows_.count() + 1);
      if (has(Parent)) named_.reserve(rows_.count() + 1);
      if (!has_header_) add(row);
      while (!problems_.is_full() && rows_.next(row)) add(row);
      if (list_.size() == 0 && problems_.none()) problems_.complain_of_file("the table has a header, but no rows");
    }
    const bool are_rows_good = problems_.none();
    if (!problems_.is_full() && has(Parent)) link();
    SkeletonFile made;
    if (are_rows_good) made = std::move(list_).finish();
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);
  bool has(Column column) const { return places_[column] != absent; }

  void find_columns(const std::vector<TableField>& first) {
    places_.fill(absent);
    bool are_all_counted = true;
    for (const auto& wanted : wanted_) are_all_counted = are_all_counted && (!wanted || wanted->index() == 1);
    are_all_counted = are_all_counted && wanted_[X] && wanted_[Y] && wanted_[Z];
    for (std::size_t c = 0; c < Columns; ++c)
      if (wanted_[c]) find_wanted(static_cast<Column>(c), first);
      else if (!are_all_counted) find_usual(static_cast<Column>(c), first);
    check_columns(first, are_all_counted);
  }

  void find_wanted(Column column, const std::vector<TableField>& first) {
    const ColumnName& wanted = *wanted_[column];
    if (const int* number = std::get_if<int>(&wanted)) {
      places_[column] = static_cast<std::size_t>(*number - 1);
      if (places_[column] >= first.size())
        problems_.complain_of_line(first[0].place,
                                   fmt::format("there is no column {}: the first row has {}", *number, first.size()));
      return;
    }
    const std::string& name = std::get<std::string>(wanted);
    std::vector<std::string> known;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i].text == name) take(column, first[i], i);
      if (known.size() < 100) known.emplace_back(first[i].text.substr(0, 40));
    }
    if (has(column)) return;
    problems_.complain_of_line(first[0].place, fmt::format("the header has no column {}", quoted_word(name)),
                               suggest(name, known));
  }

  void find_usual(Column column, const std::vector<TableField>& first) {
    for (std::size_t i = 0; i < first.size(); ++i)
      if (lower_case(first[i].text) == column_names[column]) take(column, first[i], i);
  }

  // Which of two columns of one name is meant only the author knows.
  void take(Column column, const TableField& field, std::size_t place) {
    if (has(column))
      problems_.complain(field.place, fmt::format("the header has {} twice", quoted_word(field.text)),
                         fmt::format("choose one by its number: columns: {{{}: {}}}", column_names[column], place + 1));
    else places_[column] = place;
  }

  void check_columns(const std::vector<TableField>& first, bool are_all_counted) {
    if (!problems_.none()) return;
    const char* const hint = "say which they are, by name or by number: columns: {x: 1, y: 2, z: 3, radius: 4}";
    for (const Column c : {X, Y, Z})
      if (!has(c))
        return problems_.complain_of_line(first[0].place,
                                          fmt::format("the header names no column `{}`", column_names[c]), hint);
    if (!has(Radius) && !options_.radius)
      return problems_.complain_of_line(first[0].place, "the table has no column for the radius",
                                        "give the skeleton a `radius`, or `columns: {radius: ...}`");
    if (has(Strand) && has(Parent)) choose_joining();
    if (has(Strand) && has(Parent))
      return problems_.complain_of_line(first[0].place, "the rows are joined both by strands and by parents",
                                        "choose one of the columns");
    has_header_ = !are_all_counted || !rows_.number(first[places_[X]].text);
    fields_ = first.size();
    for (const std::size_t place : places_)
      if (place != absent) width_ = std::max(width_, place + 1);
  }

  // A column that the scene names goes before one that only has a usual name; of two such, the parents win.
  void choose_joining() {
    if (!wanted_[Strand]) places_[Strand] = absent;
    else if (!wanted_[Parent]) places_[Parent] = absent;
  }

  std::optional<double> number(const std::vector<TableField>& row, Column column) {
    const TableField& field = row[places_[column]];
    const auto value = rows_.number(field.text);
    if (!value)
      problems_.complain(field.place, fmt::format("{} is not a finite number", quoted_word(field.text)),
                         fmt::format("the column holds `{}`", column_names[column]));
    return value;
  }

  void add(const std::vector<TableField>& row) {
    if (has(Parent)) add_name(row);
    if (row.size() < width_)
      return problems_.complain(row.back().text.data() + row.back().text.size(),
                                fmt::format("the row has {} fields, column {} is needed", row.size(), width_));
    if (row.size() > fields_ && !are_blank(std::span(row).subspan(fields_)))
      return problems_.complain(row[fields_].place,
                                fmt::format("the row has {} fields, the first has {}", row.size(), fields_),
                                "decimal commas need another separator, such as semicolons");
    if (has(Strand) && row[places_[Strand]].text.empty())
      return problems_.complain(row[places_[Strand]].place, "the row names no strand",
                                "a strand is any word; rows of one word are joined");
    const auto x = number(row, X), y = number(row, Y), z = number(row, Z);
    const auto radius = options_.radius ? options_.radius : number(row, Radius);
    std::int32_t parent = -1;
    if (has(Strand)) parent = std::exchange(last_of(row[places_[Strand]].text), list_.next_index());
    const auto place = [&](Column column) { return row[places_[column]].place; };
    list_.add({x.value_or(0), y.value_or(0), z.value_or(0)}, radius.value_or(0), parent,
              NodePlaces{{place(X), place(Y), place(Z)}, options_.radius ? nullptr : place(Radius)});
  }

  static bool are_blank(std::span<const TableField> fields) {
    return std::ranges::all_of(fields, [](const TableField& field) { return field.text.empty(); });
  }

  // The last node of a strand so far, or -1. Rows of one strand nearly always follow each other.
  std::int32_t& last_of(std::string_view strand) {
    if (!last_ || strand != last_strand_) last_ = &last_of_strand_.try_emplace(strand, -1).first->second;
    last_strand_ = strand;
    return *last_;
  }

  std::optional<std::int64_t> whole(const std::vector<TableField>& row, Column column) {
    const auto value = number(row, column);
    const auto id = value ? whole_number(*value) : std::nullopt;
    if (value && !id)
      problems_.complain(row[places_[column]].place,
                         fmt::format("{} is not a whole number", quoted_word(row[places_[column]].text)));
    return id;
  }

  // A row with mistakes keeps its name, so that what refers to it is not a second mistake.
  void add_name(const std::vector<TableField>& row) {
    ++rows_so_far_;
    const auto reaches = [&](Column column) { return places_[column] < row.size(); };
    if (has(Id) && !reaches(Id)) return;
    const auto id = has(Id) ? whole(row, Id) : std::optional(rows_so_far_);
    const bool is_root = !reaches(Parent) || row[places_[Parent]].text.empty();
    const auto parent = is_root ? std::nullopt : whole(row, Parent);
    if (!id) return;
    has_id_0_ = has_id_0_ || *id == 0;
    const char* const start = row[0].place;
    named_.push_back({*id, parent.value_or(NamedNode::no_parent), has(Id) ? row[places_[Id]].place : start,
                      is_root ? start : row[places_[Parent]].place});
  }

  void link() {
    // A negative id could be its own parent -1 by accident: roots are told apart from nodes first.
    for (NamedNode& node : named_)
      if (node.parent < 0 || (node.parent == 0 && !has_id_0_)) node.parent = node.id == -1 ? -2 : -1;
    list_.parents() = parent_indices(named_, problems_);
  }

  const SkeletonOptions& options_;
  FileProblems problems_;
  TableRows rows_;
  NodeList list_;
  std::array<std::optional<ColumnName>, Columns> wanted_;
  std::array<std::size_t, Columns> places_{};
  std::size_t width_ = 0;   // so many fields are needed
  std::size_t fields_ = 0;  // of the first row
  bool has_header_ = true, has_id_0_ = false;
  std::int64_t rows_so_far_ = 0;
  std::unordered_map<std::string_view, std::int32_t> last_of_strand_;
  std::string_view last_strand_;
  std::int32_t* last_ = nullptr;
  std::vector<NamedNode> named_;
};

}  // namespace

Result<SkeletonFile> read_csv(std::string_view text, const SkeletonOptions& options, const std::string& name) {
  return CsvReader(text, options, name).read();
}

}  // namespace marrow
