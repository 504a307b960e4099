// Tables of the rules for the projection angle.
#include "renderer/scene/alpha_forms.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "renderer/scene/field_forms.h"
#include "renderer/scene/primitive_forms.h"

namespace marrow {
namespace {

using Two = std::array<double, 2>;

Form<Two> two_of(const Form<double>& one) {
  return mapped<Two>(list_of(one, 2, 2), [](const std::vector<double>& v) { return Two{v[0], v[1]}; });
}

struct Bounds {
  double least = 0, most = 0;
};
const Table<Bounds>& bounds_table() {
  static const Table<Bounds> table(
      "direction", "Angles by the directions of two strands.",
      {key<Bounds>("min", &Bounds::least, primitive_alpha(), "of crossing ones").required(),
       key<Bounds>("max", &Bounds::most, primitive_alpha(), "of parallel ones").required()});
  return table;
}

const Table<AlphaLocalContact>& local_contact_table() {
  static const Table<AlphaLocalContact> table(
      "local_contact", "What the angle of contact adapts to.",
      {key<AlphaLocalContact>("radii", &AlphaLocalContact::radii, boolean(),
                              "two balls of any two radii join when they touch"),
       key<AlphaLocalContact>("density", &AlphaLocalContact::density, boolean(),
                              "less is added where many skeletons meet; a torus closes when it touches itself. Kernel "
                              "`inverse` up to degree 12")});
  return table;
}

struct WrittenAlpha {
  std::optional<Two> direction, from, to;
  std::optional<std::string> attribute;
  std::optional<FieldNodeId> field;
  std::optional<AlphaLocalContact> contact;
};

bool ramp_fits(const WrittenAlpha& a, const Value& v, Reader& reader) {
  const auto wrong = [&](const std::string& message, const std::string& hint) {
    reader.error(v.place, message, hint);
    return false;
  };
  if (a.from.has_value() != a.to.has_value()) return wrong("`from` and `to` stand together", "");
  if (a.from && !a.attribute && !a.field) return wrong("`from` and `to` belong to `attribute` or `field`", "");
  if (a.field && !a.from)
    return wrong("`field` needs `from` and `to`", "from: values of the field, to: angles for them");
  if (a.from && !((*a.from)[0] < (*a.from)[1])) return wrong("`from` must rise", "the smaller value first");
  return true;
}

const Table<WrittenAlpha>& alpha_table() {
  static const Table<WrittenAlpha> table = [] {
    using A = WrittenAlpha;
    Table<A> made(
        "alpha", "A projection angle that varies from place to place.",
        {key<A>("direction", &A::direction, direction_bounds_form(),
                "[crossing, parallel]: the angle by the directions of strands; a polyline, a curve and a "
                "skeleton is one strand, points and triangles have no direction (eq. 15)"),
         key<A>("attribute", &A::attribute, name_of("the name of an attribute"),
                "the angle from an attribute of the skeletons, linear along them, or from their `radius`; "
                "contact for those without it"),
         key<A>("field", &A::field, field_node(), "the angle from the value of this field"),
         key<A>("contact", &A::contact, map_of(local_contact_table()),
                "contact that adapts to its neighbourhood: `{}`"),
         key<A>("from", &A::from, two_of(number(any_number())), "two values of the attribute or the field"),
         key<A>("to", &A::to, two_of(primitive_alpha()),
                "the angles for them; linear between, level outside. Without both the attribute is the angle")},
        ramp_fits);
    made.info.exactly_one = {"direction", "attribute", "field", "contact"};
    return made;
  }();
  return table;
}

Alpha alpha_of(const WrittenAlpha& a) {
  if (a.direction) return AlphaDirection{(*a.direction)[0], (*a.direction)[1]};
  if (a.contact) return *a.contact;
  std::optional<AlphaRamp> ramp;
  if (a.from) ramp = AlphaRamp{*a.from, *a.to};
  if (a.field) return AlphaFromField{*a.field, ramp.value_or(AlphaRamp{})};
  return AlphaAttribute{a.attribute.value_or(""), ramp};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

Form<std::array<double, 2>> direction_bounds_form() {
  const Form<Two> map = mapped<Two>(map_of(bounds_table()), [](const Bounds& b) { return Two{b.least, b.most}; });
  return either<Two>({two_of(primitive_alpha()), map}, "two angles in radians: [crossing, parallel]");
}

Form<std::vector<Attribute>> attributes_form() {
  const Form<double> one = number(any_number());
  const Form<std::vector<double>> values = either<std::vector<double>>(
      {mapped<std::vector<double>>(one, [](double x) { return std::vector{x}; }), list_of(one, 1)},
      "a number, or one for each point");
  return mapped<std::vector<Attribute>>(names_of(values), [](std::vector<Named<std::vector<double>>> all) {
    std::vector<Attribute> attributes;
    for (auto& [name, what, place] : all) attributes.push_back({std::move(name), std::move(what)});
    return attributes;
  });
}

Form<Alpha> alpha_form() {
  enum class Word { Contact, Sum, PerSkeleton };
  const auto from_word = [](Word word) {
    if (word == Word::PerSkeleton) return Alpha(AlphaPerSkeleton{});
    return word == Word::Sum ? Alpha(AlphaSum{}) : Alpha(AlphaContact{});
  };
  const auto from_angle = [](double radians) { return Alpha(radians); };
  Form<Word> word = choice<Word>({{"contact", Word::Contact}, {"sum", Word::Sum}, {"per_skeleton", Word::PerSkeleton}});
  // What begins like a word is meant as one, so that a slip gets the words as suggestions and not the range of angles.
  word.recognises = [](const Value& v) { return v.is_scalar() && !v.text.empty() && is_letter(v.text.front()); };
  return either<Alpha>({mapped<Alpha>(word, from_word), mapped<Alpha>(primitive_alpha(), from_angle),
                        mapped<Alpha>(map_of(alpha_table()), alpha_of)});
}

std::vector<const TableInfo*> alpha_tables() {
  return {&alpha_table().info, &bounds_table().info, &local_contact_table().info};
}

}  // namespace marrow
