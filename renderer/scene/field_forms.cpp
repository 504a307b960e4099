// One table for each node. A new node is a table here and an entry in field_nodes().
#include "renderer/scene/field_forms.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "field/kernel/inverse_family.h"
#include "renderer/scene/alpha_forms.h"
#include "renderer/scene/curve_forms.h"
#include "renderer/scene/node_forms.h"
#include "renderer/scene/primitive_forms.h"
#include "renderer/scene/skeleton_forms.h"

namespace marrow {
namespace {

constexpr double degree_in_radians = 3.14159265358979323846 / 180;

struct WrittenKernel {
  Kernel kernel;
  std::optional<double> scale, support;
};

Key<WrittenKernel> kernel_degree_key(const std::string& name, KernelFamily family, const std::string& doc) {
  const auto set = [family](WrittenKernel& k, int degree) {
    k.kernel.family = family;
    k.kernel.degree = degree;
  };
  return key<WrittenKernel>(name, set, integer(min_kernel_degree, max_kernel_degree), doc);
}

bool shape_fits(const WrittenKernel& k, const Value& v, Reader& reader) {
  const auto only_for = [&](bool is_given, const std::string& name, KernelFamily family, const std::string& owner) {
    if (!is_given || k.kernel.family == family) return true;
    reader.error(v.find(name)->value.place, "`" + name + "` belongs to the kernel `" + owner + "`", "");
    return false;
  };
  return only_for(k.scale.has_value(), "scale", KernelFamily::Cauchy, "cauchy") &&
         only_for(k.support.has_value(), "support", KernelFamily::Compact, "compact");
}

const Table<WrittenKernel>& kernel_table() {
  static const Table<WrittenKernel> table = [] {
    Table<WrittenKernel> made(
        "kernel", "The kernel of a blend; its degree says how far skeletons feel each other.",
        {kernel_degree_key("inverse", KernelFamily::Inverse, "x^-m of this degree: lines of it are rendered fastest"),
         kernel_degree_key("cauchy", KernelFamily::Cauchy, "(1 + scale^2 x^2)^(-m/2), finite on skeletons"),
         kernel_degree_key("compact", KernelFamily::Compact, "(1 - x^2/support^2)^(m/2), 0 beyond"),
         key<WrittenKernel>("scale", &WrittenKernel::scale, number(between(0.01, 100)), "of `cauchy`; 1 when left out"),
         key<WrittenKernel>("support", &WrittenKernel::support, number(between(1.01, 100)),
                            "of `compact`, in radii; 2 when left out; below 1.6 for topology control")},
        shape_fits);
    made.info.exactly_one = {"inverse", "cauchy", "compact"};
    return made;
  }();
  return table;
}

Form<Kernel> kernel() {
  return mapped<Kernel>(map_of(kernel_table()), [](const WrittenKernel& k) {
    Kernel kernel = k.kernel;
    if (kernel.family == KernelFamily::Cauchy) kernel.shape = k.scale.value_or(1);
    if (kernel.family == KernelFamily::Compact) kernel.shape = k.support.value_or(2);
    return kernel;
  });
}

const Table<Blend>& blend_table() {
  static const Table<Blend> table(
      "blend", "Many skeletons as one smooth body with topology control (Zanni, Cani, Gleicher 2015).",
      {key<Blend>("kernel", &Blend::kernel, kernel(), "the kernel; degree 4 when left out"),
       key<Blend>("alpha", &Blend::alpha, alpha_form(),
                  "projection angle: `contact` (when left out) blends where skeletons touch, `sum` is the plain sum, "
                  "`per_skeleton` takes the skeletons' own, a map lets it vary"),
       key<Blend>("cavity", &Blend::cavity, boolean(), "whether hollows that close are corrected too"),
       key<Blend>("projection", &Blend::projection,
                  choice<Projection>({{"paper", Projection::Paper}, {"exact", Projection::Exact}}),
                  "how the corrected value is found: in one step as published, or exactly"),
       key<Blend>("model", &Blend::model, skeleton_model(),
                  "field of the skeletons that do not say it themselves; \"What a radius is\" above"),
       key<Blend>("of", &Blend::of, list_of(field_node(), 1), "the skeletons").required()});
  return table;
}

const Table<Union>& union_table() {
  static const Table<Union> table("union", "All that is inside any of its children, with creases where they meet.",
                                  {key<Union>("of", &Union::of, list_of(field_node(), 1), "the fields").required()});
  return table;
}

struct Group {
  std::vector<FieldNodeId> of;
};
const Table<Group>& group_table() {
  static const Table<Group> table(
      "group",
      "Nodes under one name. A blend takes its skeletons as if they were listed there; elsewhere it is a union.",
      {key<Group>("of", &Group::of, list_of(field_node(), 1), "the nodes").required()});
  return table;
}
Union union_of(Group group) { return {.of = std::move(group.of), .is_group = true}; }

struct Rotation {
  Vec3d axis{0, 1, 0};
  double angle_deg = 0;
};
const Table<Rotation>& rotation_table() {
  static const Table<Rotation> table(
      "rotation", "A right-handed rotation about an axis through the origin.",
      {key<Rotation>("axis", &Rotation::axis, direction(), "the axis").required(),
       key<Rotation>("angle", &Rotation::angle_deg, degrees(any_number()), "in degrees").required()});
  return table;
}

struct Placement {
  Vec3d translate{0, 0, 0}, scale{1, 1, 1};
  Rotation rotate;
  FieldNodeId of;
};
Form<Vec3d> scaling() {
  const Form<Vec3d> each = checked(
      position(), [](const Vec3d& s) { return s.x != 0 && s.y != 0 && s.z != 0; }, "three factors, none of them 0");
  const Form<Vec3d> one = mapped<Vec3d>(number(any_radius()), [](double s) { return Vec3d{s, s, s}; });
  return either<Vec3d>({each, one}, "a factor above 0 or three of them, none 0");
}
const Table<Placement>& transform_table() {
  static const Table<Placement> table(
      "transform", "Places a subtree: scaled first, then rotated, then moved.",
      {key<Placement>("translate", &Placement::translate, position(), "by this vector"),
       key<Placement>("rotate", &Placement::rotate, map_of(rotation_table()), "about the origin"),
       key<Placement>("scale", &Placement::scale, scaling(), "from the origin; a negative factor mirrors"),
       key<Placement>("of", &Placement::of, field_node(), "what is placed").required()});
  return table;
}
Transform transform_of(const Placement& p) {
  return {.parent_from_child = Affine::translate(p.translate) *
                               Affine::rotate(normalize(p.rotate.axis), p.rotate.angle_deg * degree_in_radians) *
                               Affine::scale(p.scale),
          .of = p.of};
}

// A node that is read by `form` and then added behind its children.
template <class What, class Convert>
Form<FieldNodeId> added(const Form<What>& form, Convert convert) {
  Form<FieldNodeId> node = mapped<FieldNodeId>(form, [](const What&) { return FieldNodeId{}; });
  node.read = [form, convert](const Value& v, Reader& reader) -> std::optional<FieldNodeId> {
    auto what = form.read(v, reader);
    if (!what || !reader.spend_nodes(1, v.place)) return std::nullopt;
    return reader.field->add({.what = convert(*std::move(what)), .where = reader.sources.location(v.place)});
  };
  return node;
}
const auto as_it_is = [](auto what) { return what; };

Form<FieldNodeId> use() {
  const Form<std::string> name = name_of("the name of a subtree of `defs`");
  Form<FieldNodeId> node = mapped<FieldNodeId>(name, [](const std::string&) { return FieldNodeId{}; });
  node.read = [name](const Value& v, Reader& reader) -> std::optional<FieldNodeId> {
    const auto wanted = name.read(v, reader);
    return wanted ? reader.definitions.place(*wanted, v, *reader.field, reader) : std::nullopt;
  };
  return node;
}

const Alternatives<FieldNodeId>& field_nodes() {
  static const Alternatives<FieldNodeId> nodes = [] {
    std::vector<std::pair<std::string, Form<FieldNodeId>>> all{{"point", added(point_form(), as_it_is)},
                                                               {"segment", added(segment_form(), as_it_is)},
                                                               {"polyline", added(polyline_form(), as_it_is)},
                                                               {"curve", added(curve_form(), as_it_is)},
                                                               {"triangle", added(triangle_form(), as_it_is)},
                                                               {"circle", added(circle_form(), as_it_is)},
                                                               {"arc", added(arc_form(), as_it_is)},
                                                               {"skeleton", added(skeleton_form(), as_it_is)},
                                                               {"blend", added(map_of(blend_table()), as_it_is)},
                                                               {"union", added(map_of(union_table()), as_it_is)},
                                                               {"group", added(map_of(group_table()), union_of)}};
    for (auto& form : general_node_forms()) all.push_back(std::move(form));
    all.emplace_back("transform", added(map_of(transform_table()), transform_of));
    all.emplace_back("use", use());
    return Alternatives<FieldNodeId>("node", "One node of a field.", std::move(all));
  }();
  return nodes;
}

}  // namespace

// field_nodes() is asked for only when a value is read: its tables hold this form themselves.
Form<FieldNodeId> field_node() {
  return {.words = "a node",
          .json = reference_to("node"),
          .read = [](const Value& v, Reader& reader) { return field_nodes().read(v, reader); },
          .recognises = [](const Value& v) { return v.kind == Value::Kind::Map; }};
}

bool read_field(const Value& v, Reader& reader, FieldDescription& field) {
  reader.field = &field;
  reader.placed.clear();
  const auto root = field_node().read(v, reader);
  reader.field = nullptr;
  if (root) field.root = *root;
  return root.has_value();
}

Form<FieldDescription> field_tree() {
  Form<FieldDescription> form = mapped<FieldDescription>(field_node(), [](FieldNodeId) { return FieldDescription{}; });
  form.read = [](const Value& v, Reader& reader) -> std::optional<FieldDescription> {
    FieldDescription field;
    if (!read_field(v, reader, field)) return std::nullopt;
    return field;
  };
  return form;
}

std::vector<const TableInfo*> field_tables() {
  std::vector<const TableInfo*> tables = primitive_tables();
  for (const auto& more : {curve_tables(), skeleton_tables()}) tables.insert(tables.end(), more.begin(), more.end());
  for (const TableInfo* table : {&kernel_table().info, &blend_table().info, &union_table().info, &group_table().info,
                                 &transform_table().info, &rotation_table().info})
    tables.push_back(table);
  for (const TableInfo* table : general_node_tables()) tables.push_back(table);
  for (const TableInfo* table : alpha_tables()) tables.push_back(table);
  return tables;
}

std::vector<const AlternativesInfo*> field_alternatives() {
  std::vector<const AlternativesInfo*> all{&field_nodes().info};
  for (const AlternativesInfo* info : general_node_alternatives()) all.push_back(info);
  return all;
}

}  // namespace marrow
