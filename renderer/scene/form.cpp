// The forms of single values.
#include "renderer/scene/form.h"

#include <cmath>

#include <fmt/format.h>

#include "renderer/scene/scalar.h"

namespace marrow {
namespace {

constexpr double pi = 3.14159265358979323846;

bool is_scalar(const Value& v) { return v.is_scalar(); }

std::optional<double> plain_number(const Value& v) {
  return v.kind == Value::Kind::Plain ? parse_number(v.text) : std::nullopt;
}

std::string hint_of(const Value& v) {
  if (v.kind == Value::Kind::Quoted && parse_number(v.text)) return "without quotes it is a number";
  return v.kind == Value::Kind::Plain ? number_hint(v.text) : "";
}

template <class T>
Form<T> whole_number(const std::string& words, const std::string& json,
                     std::function<std::optional<T>(std::string_view)> parse) {
  Form<T> form;
  form.words = words;
  form.json = json;
  form.recognises = is_scalar;
  form.show = [](const T& value) { return std::to_string(value); };
  form.read = [=](const Value& v, Reader& reader) -> std::optional<T> {
    const auto value = v.kind == Value::Kind::Plain ? parse(v.text) : std::nullopt;
    if (value) return value;
    const auto real = plain_number(v);
    if (!real) return reader.wrong(v, words, hint_of(v));
    const auto digits = std::fabs(*real) < 1e15 ? fmt::format("{:.0f}", *real) : "";
    const bool is_allowed = std::floor(*real) == *real && parse(digits);
    return reader.wrong(v, words, is_allowed ? "write " + digits + ", without point or exponent" : "");
  };
  return form;
}

// A number in its own unit, or a text that ends in deg or rad.
Form<double> angle(Range range, const std::string& unit, double per_deg, double per_rad) {
  Form<double> form;
  form.words = "an angle" + range.words() + " in " + unit;
  form.json = "{\"anyOf\":[{\"type\":\"number\"" + range.json() +
              "},{\"type\":\"string\",\"pattern\":\"^[-+]?[0-9.]+([eE][-+]?[0-9]+)?(deg|rad)$\"}]}";
  form.recognises = is_scalar;
  form.show = number_text;
  form.read = [=, words = form.words](const Value& v, Reader& reader) -> std::optional<double> {
    std::string_view digits = v.text;
    double factor = 1;
    if (digits.ends_with("deg")) factor = per_deg;
    if (digits.ends_with("rad")) factor = per_rad;
    const bool has_unit = digits.ends_with("deg") || digits.ends_with("rad");
    if (has_unit) digits.remove_suffix(3);
    const bool may_be_number = v.kind == Value::Kind::Plain || (v.kind == Value::Kind::Quoted && has_unit);
    const auto number = may_be_number ? parse_number(digits) : std::nullopt;
    if (number && range.contains(*number * factor)) return *number * factor;
    return reader.wrong(v, words, has_unit || number ? "" : hint_of(v));
  };
  return form;
}

std::string limit_text(double limit) { return limit == pi / 2 ? "pi/2" : number_text(limit); }

}  // namespace

std::string Range::words() const {
  const bool has_min = min > -largest_length, has_max = max < largest_length;
  if (has_min && min_open) return " above " + limit_text(min) + (has_max ? " and at most " + limit_text(max) : "");
  if (has_min && has_max) return " from " + limit_text(min) + " to " + limit_text(max);
  return has_min ? " of at least " + limit_text(min) : has_max ? " of at most " + limit_text(max) : "";
}

std::string Range::json() const {
  std::string json;
  if (std::isfinite(min)) json += (min_open ? ",\"exclusiveMinimum\":" : ",\"minimum\":") + number_text(min);
  if (std::isfinite(max)) json += ",\"maximum\":" + number_text(max);
  return json;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c >= 0 && c < ' ') out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else out += c;
  }
  return out + '"';
}

std::string words_of_choice(const std::vector<std::string>& names) {
  return fmt::format("`{}`", fmt::join(names, "` or `"));
}
std::string json_of_choice(const std::vector<std::string>& names) {
  return fmt::format("{{\"enum\":[\"{}\"]}}", fmt::join(names, "\",\""));
}

std::string words_of_list(const std::string& item, std::size_t min, std::size_t max) {
  if (min == max) return fmt::format("a list of {}, each {}", min, item);
  return min > 1 ? fmt::format("a list of at least {}, each {}", min, item) : fmt::format("a list, each {}", item);
}
std::string json_of_list(const std::string& item, std::size_t min, std::size_t max) {
  const std::string most = max == no_limit ? "" : fmt::format(",\"maxItems\":{}", max);
  return fmt::format("{{\"type\":\"array\",\"minItems\":{}{},\"items\":{}}}", min, most, item);
}

Form<double> number(Range range) {
  Form<double> form;
  form.words = "a number" + range.words();
  form.json = "{\"type\":\"number\"" + range.json() + "}";
  form.recognises = is_scalar;
  form.show = number_text;
  form.read = [range, words = form.words](const Value& v, Reader& reader) -> std::optional<double> {
    const auto value = plain_number(v);
    if (value && range.contains(*value)) return value;
    const bool is_huge = value && std::fabs(*value) > largest_length;
    return reader.wrong(v, words, is_huge ? "nothing in a scene may be larger than 1e15" : value ? "" : hint_of(v));
  };
  return form;
}

Form<int> integer(int min, int max) {
  const Range range = between(min, max);
  return whole_number<int>("a whole number" + range.words(), "{\"type\":\"integer\"" + range.json() + "}",
                           [=](std::string_view text) -> std::optional<int> {
                             const auto value = parse_integer(text);
                             if (!value || *value < min || *value > max) return std::nullopt;
                             return static_cast<int>(*value);
                           });
}

Form<std::uint64_t> any_unsigned() {
  return whole_number<std::uint64_t>("a whole number from 0 to 2^64-1",
                                     "{\"type\":\"integer\",\"minimum\":0,\"maximum\":18446744073709551615}",
                                     parse_unsigned);
}

Form<bool> boolean() {
  return {.words = "true or false",
          .json = "{\"type\":\"boolean\"}",
          .read = [](const Value& v, Reader& reader) -> std::optional<bool> {
            const std::string& t = v.kind == Value::Kind::Plain ? v.text : std::string();
            if (t == "true" || t == "True" || t == "TRUE") return true;
            if (t == "false" || t == "False" || t == "FALSE") return false;
            if (t == "yes" || t == "on") return reader.wrong(v, "true or false", "write true");
            if (t == "no" || t == "off") return reader.wrong(v, "true or false", "write false");
            return reader.wrong(v, "true or false");
          },
          .recognises = is_scalar,
          .show = [](const bool& value) { return std::string(value ? "true" : "false"); }};
}

Form<std::string> name_of(const std::string& what) {
  return {.words = what,
          .json = "{\"type\":\"string\"}",
          .read = [what](const Value& v, Reader& reader) -> std::optional<std::string> {
            const bool is_other =
                v.kind == Value::Kind::Plain && (parse_number(v.text) || v.text == "true" || v.text == "false");
            if (!v.is_scalar() || is_other)
              return reader.wrong(v, what, is_other ? "in quotes it is a text: \"" + v.text + "\"" : "");
            return v.text;
          },
          .recognises = is_scalar,
          .show = [](const std::string& value) { return value; }};
}

Form<std::string> text() { return name_of("a text"); }

Form<Vec3d> position() {
  const Form<std::vector<double>> three = list_of(number(any_coordinate()), 3, 3);
  Form<Vec3d> form = mapped<Vec3d>(three, [](const std::vector<double>& v) { return Vec3d{v[0], v[1], v[2]}; });
  form.words = "a vector [x, y, z]";
  form.read = [read = form.read, words = form.words](const Value& v, Reader& reader) -> std::optional<Vec3d> {
    if (v.kind != Value::Kind::List || v.items.size() != 3) return reader.wrong(v, words);
    return read(v, reader);
  };
  form.show = [](const Vec3d& v) { return numbers_text(v.x, v.y, v.z); };
  return form;
}

Form<Vec3d> direction() {
  return checked(
      position(), [](const Vec3d& v) { return v != Vec3d{}; }, "a direction [x, y, z] that is not zero");
}

Form<double> degrees(Range range) { return angle(range, "degrees", 1, 180 / pi); }
Form<double> radians(Range range) { return angle(range, "radians", pi / 180, 1); }

Form<std::filesystem::path> file_name() {
  const Form<std::string> name = name_of("the name of a file");
  Form<std::filesystem::path> form = mapped<std::filesystem::path>(name, [](std::string t) { return t; });
  form.read = [name](const Value& v, Reader& reader) -> std::optional<std::filesystem::path> {
    const auto given = name.read(v, reader);
    if (!given) return std::nullopt;
    if (given->empty()) return reader.wrong(v, name.words);
    return reader.resolve(*given, v.place);
  };
  return form;
}

Form<MaterialId> material_name() {
  const Form<std::string> name = name_of("the name of a material");
  Form<MaterialId> form = mapped<MaterialId>(name, [](const std::string&) { return MaterialId{}; });
  form.read = [name](const Value& v, Reader& reader) -> std::optional<MaterialId> {
    const auto given = name.read(v, reader);
    if (!given) return std::nullopt;
    const auto found = std::find(reader.materials.begin(), reader.materials.end(), *given);
    if (found == reader.materials.end()) return reader.unknown("material", *given, v.place, reader.materials);
    return MaterialId{static_cast<std::size_t>(found - reader.materials.begin())};
  };
  return form;
}

}  // namespace marrow
