// The table of skeleton files, and which of its keys belong to which format.
#include "renderer/scene/skeleton_forms.h"

#include <filesystem>
#include <memory>
#include <utility>

#include "field/skeleton/curve_graph.h"
#include "renderer/scene/curve_forms.h"
#include "renderer/scene/drawn.h"
#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/skeleton_file.h"
#include "renderer/scene/scalar.h"

namespace marrow {
namespace {

struct FileSkeleton {
  std::filesystem::path file;
  std::optional<SkeletonFormat> format;
  SkeletonOptions options;
  std::optional<double> tolerance;  // of simplify
  std::optional<Subdivision> subdivision;
  std::optional<int> levels;

  // Smoothing is asked for by either of its keys.
  int all_levels() const { return levels.value_or(subdivision ? 2 : 0); }
  std::optional<SkeletonFormat> any_format() const { return format ? format : skeleton_format_of(file.string()); }
};
using File = Drawn<FileSkeleton>;

// A key of the options inside.
template <class T, class Member>
Key<File> option(std::string name, Member SkeletonOptions::*member, const Form<T>& form, std::string doc) {
  return key<File>(
      std::move(name), [member](File& f, T value) { f.options.*member = std::move(value); }, form, std::move(doc));
}

Form<ColumnName> column_name() {
  const Form<int> number = integer(1, 10'000);
  const Form<std::string> name = name_of("the name of a column, or its number from 1");
  Form<ColumnName> form = mapped<ColumnName>(name, [](std::string text) { return text; });
  form.json = "{\"anyOf\":[" + number.json + "," + name.json + "]}";
  form.read = [=](const Value& v, Reader& reader) -> std::optional<ColumnName> {
    if (v.kind == Value::Kind::Plain && parse_integer(v.text)) return number.read(v, reader);
    return name.read(v, reader);
  };
  return form;
}

const Table<CsvColumns>& columns_table() {
  using C = CsvColumns;
  static const Table<C> table(
      "columns",
      "Which column of a table holds what, by its name in the header or its number from 1. Columns that are "
      "left out are those of the names used here, if the header has them.",
      {key<C>("x", &C::x, column_name(), "first coordinate"), key<C>("y", &C::y, column_name(), "second coordinate"),
       key<C>("z", &C::z, column_name(), "third coordinate"),
       key<C>("radius", &C::radius, column_name(), "not needed where the skeleton has a `radius`"),
       key<C>("strand", &C::strand, column_name(), "rows with the same value are joined, in the order of the file"),
       key<C>("id", &C::id, column_name(), "what `parent` refers to; rows are counted from 1 without it"),
       key<C>("parent", &C::parent, column_name(), "each row is joined to this one; empty, 0 or negative at a root")});
  return table;
}

Form<SkeletonFormat> format_name() {
  return choice<SkeletonFormat>({{"swc", SkeletonFormat::Swc},
                                 {"obj", SkeletonFormat::Obj},
                                 {"csv", SkeletonFormat::Csv},
                                 {"xyz", SkeletonFormat::Xyz},
                                 {"pdb", SkeletonFormat::Pdb},
                                 {"hair", SkeletonFormat::CyHair}});
}

Form<std::string> element_symbol() {
  return checked(
      name_of("the symbol of an element"), [](const std::string& s) { return find_element(s).has_value(); },
      "the symbol of an element");
}

// Keys that a format knows nothing about are mistakes.
bool keys_fit(const File& file, const Value& v, Reader& reader) {
  bool fit = true;
  if (const Member* scale = v.find("radius_scale"); scale && file.options.radius) {
    reader.error(scale->place, "`radius_scale` has no effect beside `radius`", "leave out one of them",
                 scale->key.size());
    fit = false;
  }
  const auto format = file.any_format();
  if (!format) return fit;  // said when the file is opened
  const bool is_molecule = *format == SkeletonFormat::Xyz || *format == SkeletonFormat::Pdb;
  const auto refuse = [&](const char* name, const char* which) {
    const Member* member = v.find(name);
    if (!member) return;
    reader.error(member->place, "`" + member->key + "` is for " + which + " only", "", member->key.size());
    fit = false;
  };
  if (*format != SkeletonFormat::Csv) refuse("columns", "tables (csv, tsv)");
  if (!is_molecule) refuse("elements", "molecules (xyz, pdb)");
  if (!is_molecule) refuse("bonds", "molecules (xyz, pdb)");
  return fit;
}

const Table<File>& skeleton_table() {
  using Options = SkeletonOptions;
  static const Table<File> table(
      "skeleton",
      "The branches, curves, strands or atoms of a file: SWC (neurons, vessels, plants), the lines of OBJ, tables "
      "(CSV), "
      "molecules (XYZ, PDB) as balls with their van der Waals radii, hair (cyHair).",
      with_common_keys<FileSkeleton>(
          {key<File>("file", &FileSkeleton::file, file_name(), "relative to this one").required(),
           key<File>("format", &FileSkeleton::format, format_name(),
                     "where the ending does not say it: .swc, .obj, .csv, .tsv, .xyz, .extxyz, .pdb, .ent, .hair"),
           option("scale", &Options::scale, number(any_radius()), "multiplies positions and radii"),
           option("radius", &Options::radius, number(any_radius()),
                  "of all nodes, in scene units; without it the file must say the radii"),
           option("radius_scale", &Options::radius_scale, number(any_radius()), "multiplies the radii once more"),
           option("min_radius", &Options::min_radius, number(any_radius()),
                  "thinner places are made this thick; in scene units, after `scale`"),
           option("columns", &Options::columns, map_of(columns_table()), "tables only: which column holds what"),
           option("elements", &Options::elements, list_of(element_symbol(), 1),
                  "molecules only: the atoms to take, with their halves of bonds; all when left out"),
           option("bonds", &Options::bonds, number(any_radius()),
                  "molecules only: radius of the bonds, in scene units; none when left out"),
           key<File>("simplify", &FileSkeleton::tolerance, number(any_radius()),
                     "leaves out nodes of branches that are no farther, in place and in radius, from their neighbours' "
                     "segment; in scene units, before smoothing"),
           key<File>("subdivision", &FileSkeleton::subdivision, subdivision_name(),
                     "smooths branches as a `curve`; junctions and ends stay"),
           key<File>(
               "levels", &FileSkeleton::levels, integer(0, CurveSkeleton::max_levels),
               "level of detail of `subdivision`, which is `chaikin` when left out: each doubles the segments; 2 with "
               "`subdivision`, else 0, when left out")}),
      keys_fit);
  return table;
}

std::string id_of(const std::optional<ColumnName>& column) {
  if (!column) return ",";
  const int* number = std::get_if<int>(&*column);
  return number ? std::to_string(*number) + ',' : '"' + std::get<std::string>(*column) + "\",";
}

// Differs wherever the skeletons differ.
std::string id_of(const FileSkeleton& wanted) {
  const SkeletonOptions& o = wanted.options;
  std::string id =
      wanted.file.string() + '\n' + (wanted.format ? std::to_string(static_cast<int>(*wanted.format)) : "");
  for (const double x : {o.scale, o.radius_scale, o.radius.value_or(0), o.min_radius.value_or(0), o.bonds.value_or(0),
                         wanted.tolerance.value_or(0), static_cast<double>(wanted.all_levels()),
                         wanted.subdivision == Subdivision::Cubic ? 1.0 : 0.0})
    id += '\n' + number_text(x);
  const CsvColumns& c = o.columns;
  for (const auto& column : {c.x, c.y, c.z, c.radius, c.strand, c.id, c.parent}) id += '\n' + id_of(column);
  for (const std::string& element : o.elements) id += '\n' + element;
  return id;
}

// Null after reporting a skeleton that grows too large.
SharedSkeletonGraph refined(SkeletonGraph graph, const FileSkeleton& wanted, const Place& at, Reader& reader) {
  if (wanted.tolerance) graph = simplify(graph, *wanted.tolerance);
  const int levels = wanted.all_levels();
  if (levels == 0) return std::make_shared<const SkeletonGraph>(std::move(graph));
  if (graph.positions.size() > NodeList::max_nodes >> levels) {
    reader.error(at,
                 "the skeleton grows too large: " + std::to_string(graph.positions.size()) + " nodes, doubled " +
                     std::to_string(levels) + " times",
                 "use fewer `levels`");
    return nullptr;
  }
  return std::make_shared<const SkeletonGraph>(
      subdivide(graph, wanted.subdivision.value_or(Subdivision::Chaikin), levels));
}

SharedSkeletonGraph load(const FileSkeleton& wanted, const Place& at, Reader& reader) {
  const auto [known, is_new] = reader.skeletons.try_emplace(id_of(wanted));
  SharedSkeletonGraph& graph = known->second;  // stays null after a mistake, so that it is reported once
  if (!is_new) return graph;
  auto file = reader.open(wanted.file, at);
  if (!file) return graph;
  const auto format = wanted.any_format();
  if (!format) {
    reader.error(at, "cannot tell the format of the skeleton by the ending of its name",
                 "give it: format: swc, obj, csv, xyz, pdb or hair");
    return graph;
  }
  auto made = read_skeleton(*format, file->bytes, wanted.options, wanted.file.string());
  if (made) graph = refined(std::move(made->graph), wanted, at, reader);
  reader.report_file(wanted.file, std::move(file->bytes), made ? made->warnings : made.why());
  return graph;
}

}  // namespace

Form<Primitive> skeleton_form() {
  const Form<File> map = map_of(skeleton_table());
  Form<Primitive> form = mapped<Primitive>(map, [](const File&) { return Primitive{}; });
  form.read = [map](const Value& v, Reader& reader) -> std::optional<Primitive> {
    const auto wanted = map.read(v, reader);
    if (!wanted) return std::nullopt;
    auto graph = load(*wanted, v.find("file")->value.place, reader);
    return graph ? std::optional(primitive_with(std::move(graph), *wanted)) : std::nullopt;
  };
  return form;
}

std::vector<const TableInfo*> skeleton_tables() { return {&skeleton_table().info, &columns_table().info}; }

}  // namespace marrow
