// The four ways to write a colour, as forms.
#include "renderer/scene/colour.h"

#include <charconv>

#include "field/math/elementary.h"
#include "renderer/scene/scalar.h"

namespace marrow {
namespace {

double from_srgb(double code) { return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4); }

std::optional<int> hex_number(std::string_view digits) {
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc{} || end != digits.data() + digits.size() || value < 0) return std::nullopt;
  return value;
}

struct Temperature {
  double kelvin = 6500, luminance = 1;
};

const Table<Temperature>& kelvin_table() {
  static const Table<Temperature> table(
      "kelvin", "The colour of a black body.",
      {key<Temperature>("kelvin", &Temperature::kelvin, number(between(1667, 25000)), "temperature").required(),
       key<Temperature>("luminance", &Temperature::luminance, number(at_least(0)), "of the colour")});
  return table;
}

Form<Rgb> hexadecimal() {
  Form<Rgb> form;
  form.words = "\"#rrggbb\"";
  form.json = R"({"type":"string","pattern":"^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$"})";
  form.recognises = [](const Value& v) { return v.kind == Value::Kind::Quoted && v.text.starts_with('#'); };
  form.read = [words = form.words](const Value& v, Reader& reader) -> std::optional<Rgb> {
    const auto rgb = parse_srgb(v.text);
    return rgb ? rgb : reader.wrong(v, words + " with three or six hexadecimal digits");
  };
  return form;
}

bool is_within(const Rgb& c, const Range& range) {
  return range.contains(c.r) && range.contains(c.g) && range.contains(c.b);
}

}  // namespace

std::optional<Rgb> parse_srgb(std::string_view text) {
  if (!text.starts_with('#') || (text.size() != 4 && text.size() != 7)) return std::nullopt;
  const std::size_t width = (text.size() - 1) / 3;
  Rgb rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto code = hex_number(text.substr(1 + i * width, width));
    if (!code) return std::nullopt;
    rgb[i] = from_srgb(*code / (width == 1 ? 15.0 : 255.0));
  }
  return rgb;
}

Rgb black_body_colour(double kelvin) {
  const double t = 1000 / kelvin;
  const double x = kelvin <= 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                                  : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
  const double y = kelvin <= 2222   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                   : kelvin <= 4000 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                    : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  const double X = x / y, Z = (1 - x - y) / y;  // Y = 1
  // XYZ to linear Rec.709, IEC 61966-2-1 with more digits.
  Rgb c{3.2404541621 * X - 1.5371385128 - 0.4985314096 * Z, -0.9692660305 * X + 1.8760108454 + 0.0415560175 * Z,
        0.0556434310 * X - 0.2040259135 + 1.0572251882 * Z};
  for (std::size_t i = 0; i < 3; ++i) c[i] = std::max(c[i], 0.0);
  return c / luminance(c);
}

Form<Rgb> colour(Range range) {
  const auto from_list = [](const std::vector<double>& v) { return Rgb{v[0], v[1], v[2]}; };
  const auto from_kelvin = [](const Temperature& t) { return black_body_colour(t.kelvin) * t.luminance; };
  const std::string words = "a colour ([r, g, b], \"#rrggbb\", {kelvin: 5600} or a grey) with channels" + range.words();
  Form<Rgb> grey = mapped<Rgb>(number(range), [](double level) { return Rgb(level); });
  grey.recognises = [](const Value& v) { return v.kind == Value::Kind::Plain && parse_number(v.text); };
  Form<Rgb> form = either<Rgb>({hexadecimal(), mapped<Rgb>(list_of(number(range), 3, 3), from_list), grey,
                                mapped<Rgb>(map_of(kelvin_table()), from_kelvin)},
                               words);
  form = checked(
      form, [range](const Rgb& c) { return is_within(c, range); }, words);
  form.read = [read = form.read, words](const Value& v, Reader& reader) -> std::optional<Rgb> {
    if (v.kind != Value::Kind::Absent) return read(v, reader);
    return reader.wrong(v, words, "`#` starts a comment; write such a colour in quotes: \"#c89664\"");
  };
  form.show = [](const Rgb& c) { return numbers_text(c.r, c.g, c.b); };
  return form;
}

Form<Rgb> albedo() { return colour(between(0, 1)); }
Form<Rgb> radiance() { return colour(at_least(0)); }

const TableInfo& kelvin_table_info() { return kelvin_table().info; }

}  // namespace marrow
