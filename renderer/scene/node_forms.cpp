#include "renderer/scene/node_forms.h"

#include <numbers>
#include <optional>
#include <type_traits>

#include "field/tree/any_node.h"
#include "renderer/scene/field_forms.h"

namespace marrow {
namespace {

constexpr double degree_in_radians = std::numbers::pi / 180;

// Parameters of a kind of node or of a choice inside one.
template <class Kind>
struct Written : Kind {
  std::vector<FieldNodeId> of;
  MaterialId material;
};

template <class Choice>
const Alternatives<Choice>& alternatives_of();
template <class Choice>
Form<Choice> form_of_choice();

Form<double> form_of(const form::Real& r) { return number({.min = r.min, .max = r.max, .min_open = r.min_open}); }
Form<int> form_of(const form::Whole& w) { return integer(w.min, w.max); }
Form<bool> form_of(const form::Switch&) { return boolean(); }
Form<Vec3d> form_of(const form::Position&) { return position(); }
Form<UnitVec3> form_of(const form::Direction&) {
  Form<UnitVec3> form = mapped<UnitVec3>(direction(), normalize);
  form.show = [show = direction().show](const UnitVec3& d) { return show(d.vec()); };
  return form;
}
Form<Vec3d> form_of(const form::Sizes&) {
  return checked(
      position(), [](const Vec3d& s) { return s.x > 0 && s.y > 0 && s.z > 0; }, "three lengths above 0");
}
Form<std::vector<Vec3d>> form_of(const form::Points& p) { return list_of(position(), p.min_count); }
Form<std::vector<double>> form_of(const form::Reals& r) {
  const Form<double> one = number({.min = r.min, .max = r.max, .min_open = r.min_open});
  Form<std::vector<double>> form = either<std::vector<double>>(
      {mapped<std::vector<double>>(one, [](double x) { return std::vector{x}; }), list_of(one, 1)});
  form.show = [show = one.show](const std::vector<double>& all) {
    std::string text;
    for (const double x : all) text += (text.empty() ? "" : ", ") + show(x);
    return all.size() == 1 ? text : "[" + text + "]";
  };
  return form;
}
Form<std::vector<std::vector<double>>> form_of(const form::Rows& r) {
  return list_of(list_of(number(between(r.min, r.max)), 1), 1);
}

// What is drawn is never meant when points are left out.
constexpr bool is_required(const form::Points&) { return true; }
template <class Form>
constexpr bool is_required(const Form& form) {
  if constexpr (requires { form.required; }) return form.required;
  else return false;
}

// Called by a kind's keys() with each parameter.
template <class Kind>
class KeysOf {
 public:
  using Owner = Written<Kind>;
  explicit KeysOf(std::vector<Key<Owner>>& keys) : keys_(keys) {}

  template <class T, class Form>
  void operator()(const char* name, T Kind::*member, const Form& form, const char* doc) const {
    Key<Owner> made = make(name, member, form, doc);
    keys_.push_back(is_required(form) ? std::move(made).required() : std::move(made));
  }

 private:
  template <class T, class Form>
  static Key<Owner> make(const char* name, T Kind::*member, const Form& form, const char* doc) {
    return key<Owner>(name, member, form_of(form), doc);
  }
  static Key<Owner> make(const char* name, double Kind::*member, const form::Angle& a, const char* doc) {
    const auto set = [member](Owner& owner, double degrees) { owner.*member = degrees * degree_in_radians; };
    const Form<double> form = degrees(between(a.min_deg, a.max_deg));
    Key<Owner> made = key<Owner>(name, set, form, doc);
    if (form.show) made.info.fallback = form.show(Owner{}.*member / degree_in_radians);
    return made;
  }
  template <class Enum>
  static Key<Owner> make(const char* name, Enum Kind::*member, const form::Word&, const char* doc) {
    std::vector<std::pair<std::string, Enum>> words;
    for (const auto& [word, value] : words_of(Enum{})) words.emplace_back(word, value);
    return key<Owner>(name, member, choice<Enum>(std::move(words)), doc);
  }
  template <class Choice>
  static Key<Owner> make(const char* name, Choice Kind::*member, const form::OneOf&, const char* doc) {
    return key<Owner>(name, member, form_of_choice<Choice>(), doc);
  }

  std::vector<Key<Owner>>& keys_;
};

template <class Kind>
std::vector<Key<Written<Kind>>> keys_of() {
  std::vector<Key<Written<Kind>>> keys;
  Kind::keys(KeysOf<Kind>(keys));
  return keys;
}

// `{wyvill: {range: 1}}`, or only the name.
template <class Kind>
const Table<Written<Kind>>& choice_table() {
  static const Table<Written<Kind>> table(std::string(Kind::info.name), std::string(Kind::info.doc), keys_of<Kind>());
  return table;
}
template <class Choice, class Kind>
std::pair<std::string, Form<Choice>> one_choice() {
  return {std::string(Kind::info.name), mapped<Choice>(map_of(choice_table<Kind>()), [](const Written<Kind>& written) {
            return Choice(static_cast<const Kind&>(written));
          })};
}

template <class Choice>
struct Choices;
template <class... Kinds>
struct Choices<std::variant<Kinds...>> {
  using Choice = std::variant<Kinds...>;
  static std::vector<std::pair<std::string, Form<Choice>>> forms() { return {one_choice<Choice, Kinds>()...}; }
  static std::vector<std::pair<std::string, Choice>> words() {
    return {std::pair<std::string, Choice>(std::string(Kinds::info.name), Kinds{})...};
  }
  static std::vector<const TableInfo*> tables() { return {&choice_table<Kinds>().info...}; }
};

// Name and documentation of each choice that a parameter may be.
constexpr std::pair<const char*, const char*> text_of(const Potential*) {
  return {"potential", "How a bounded field falls to 0 around its surface."};
}
constexpr std::pair<const char*, const char*> text_of(const Bulge*) {
  return {"bulge", "What rises around the place where two bodies touch."};
}
constexpr std::pair<const char*, const char*> text_of(const WidthSolution*) {
  return {"width_solution", "Where the weights of a weighted blend act."};
}
template <class... Choice>
struct ChoiceList {};
using AllChoices = ChoiceList<Potential, Bulge, WidthSolution>;

template <class Choice>
const Alternatives<Choice>& alternatives_of() {
  constexpr auto text = text_of(static_cast<const Choice*>(nullptr));
  static const Alternatives<Choice> all(text.first, text.second, Choices<Choice>::forms());
  return all;
}
template <class Choice>
Form<Choice> form_of_choice() {
  std::vector<std::string> names;
  const auto words = Choices<Choice>::words();
  for (const auto& [name, value] : words) names.push_back(name);
  Form<Choice> word = mapped<Choice>(text(), [](const std::string&) { return Choice{}; });
  word.words = words_of_choice(names);
  word.json = json_of_choice(names);
  word.recognises = [](const Value& v) { return v.is_scalar(); };
  word.read = [words, names](const Value& v, Reader& reader) -> std::optional<Choice> {
    for (const auto& [name, value] : words)
      if (v.text == name) return value;
    return reader.unknown("value of " + reader.subject, v.text, v.place, names);
  };
  Form<Choice> form = either<Choice>({one_of(alternatives_of<Choice>()), word});
  form.show = [names](const Choice& choice) { return names[choice.index()]; };
  return form;
}

// Objects have a `plane` too, and each table has a name of its own.
std::string name_of_table(const NodeInfo& info) { return info.name == "plane" ? "plane_node" : std::string(info.name); }

template <class Kind>
const Table<Written<Kind>>& node_table() {
  static const Table<Written<Kind>> table = [] {
    using Owner = Written<Kind>;
    constexpr NodeInfo info = Kind::info;
    std::vector<Key<Owner>> keys = keys_of<Kind>();
    if constexpr (info.max_children == 0) {
      keys.push_back(key<Owner>("material", &Owner::material, material_name(), "the object's when left out"));
    } else if constexpr (info.max_children == 1) {
      const auto set = [](Owner& owner, FieldNodeId child) { owner.of = {child}; };
      keys.push_back(key<Owner>("of", set, field_node(), "the field it changes").required());
    } else {
      const std::size_t most = info.max_children == any_number_of_children ? no_limit : info.max_children;
      keys.push_back(
          key<Owner>("of", &Owner::of, list_of(field_node(), info.min_children, most), "the fields").required());
    }
    return Table<Owner>(name_of_table(info), std::string(info.doc), std::move(keys),
                        [](const Owner& owner, const Value& v, Reader& reader) {
                          if constexpr (requires { owner.problem(owner.of.size()); }) {
                            const std::string wrong = owner.problem(owner.of.size());
                            if (!wrong.empty()) reader.error(v.place, wrong, "");
                            return wrong.empty();
                          }
                          return true;
                        });
  }();
  return table;
}

template <class Kind>
Form<FieldNodeId> node_form() {
  const Form<Written<Kind>> written = map_of(node_table<Kind>());
  Form<FieldNodeId> node = mapped<FieldNodeId>(written, [](const Written<Kind>&) { return FieldNodeId{}; });
  node.read = [written](const Value& v, Reader& reader) -> std::optional<FieldNodeId> {
    auto what = written.read(v, reader);
    if (!what || !reader.spend_nodes(1, v.place)) return std::nullopt;
    GeneralNode made{.node = boxed(static_cast<Kind&&>(*what)), .of = std::move(what->of), .material = what->material};
    return reader.field->add({.what = std::move(made), .where = reader.sources.location(v.place)});
  };
  return node;
}

template <class Variant>
struct Kinds;
template <class... Kind>
struct Kinds<std::variant<Kind...>> {
  static std::vector<std::pair<std::string, Form<FieldNodeId>>> forms() {
    return {std::pair{std::string(Kind::info.name), node_form<Kind>()}...};
  }
  static std::vector<const TableInfo*> tables() { return {&node_table<Kind>().info...}; }
};

}  // namespace

std::vector<std::pair<std::string, Form<FieldNodeId>>> general_node_forms() { return Kinds<AnyNode>::forms(); }

std::vector<const TableInfo*> general_node_tables() {
  std::vector<const TableInfo*> tables = Kinds<AnyNode>::tables();
  const auto add = [&](const std::vector<const TableInfo*>& more) {
    tables.insert(tables.end(), more.begin(), more.end());
  };
  [&]<class... Choice>(ChoiceList<Choice...>) { (add(Choices<Choice>::tables()), ...); }(AllChoices{});
  return tables;
}

std::vector<const AlternativesInfo*> general_node_alternatives() {
  return []<class... Choice>(ChoiceList<Choice...>) {
    return std::vector<const AlternativesInfo*>{&alternatives_of<Choice>().info...};
  }(AllChoices{});
}

}  // namespace marrow
