// What a value may look like: one description that reads it, prints its schema and words its mistakes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field/base/id.h"
#include "field/math/vec3.h"
#include "renderer/scene/document.h"
#include "renderer/scene/reader.h"

namespace marrow {

template <class T>
struct Form {
  std::string words;  ///< completes "it must be …"
  std::string json;   ///< JSON Schema fragment; empty: nothing of this form is valid in this version
  /// The value, or nothing after reporting why.
  std::function<std::optional<T>(const Value&, Reader&)> read;
  /// Whether either() should choose this form for a value; it may still find mistakes in it.
  std::function<bool(const Value&)> recognises;
  /// As a scene would write it; empty for what has no short text.
  std::function<std::string(const T&)> show = {};
};

/// Numbers that are allowed.
struct Range {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool min_open = false;

  bool contains(double x) const { return (min_open ? x > min : x >= min) && x <= max; }
  std::string words() const;  ///< " above 0", " from 0 to 1", ""
  std::string json() const;   ///< `,"exclusiveMinimum":0`
};
constexpr Range any_number() { return {}; }
constexpr Range at_least(double min) { return {.min = min}; }
constexpr Range above(double min) { return {.min = min, .min_open = true}; }
constexpr Range between(double min, double max) { return {.min = min, .max = max}; }
/// Coordinates and lengths stay far below 1.8e18, beyond which Embree ignores boxes.
inline constexpr double largest_length = 1e15;
constexpr Range any_coordinate() { return between(-largest_length, largest_length); }
constexpr Range any_radius() { return {.min = 0, .max = largest_length, .min_open = true}; }

std::string json_string(std::string_view);

Form<double> number(Range);
Form<int> integer(int min, int max);
Form<std::uint64_t> any_unsigned();
Form<bool> boolean();
Form<std::string> text();
/// A text that names something new or old; `what` is for its words.
Form<std::string> name_of(const std::string& what);
Form<Vec3d> position();
/// [x, y, z], not zero; length does not matter.
Form<Vec3d> direction();
/// Degrees: a number, or a text with a unit: 35deg, 0.5rad.
Form<double> degrees(Range in_degrees);
/// Radians: a number, or a text with a unit.
Form<double> radians(Range in_radians);
/// A file, resolved against the folder of the text that names it. Not opened.
Form<std::filesystem::path> file_name();
Form<MaterialId> material_name();

std::string words_of_choice(const std::vector<std::string>& names);
std::string json_of_choice(const std::vector<std::string>& names);

/// One of some words. `later` are words of the format that this version does not know what to do with.
template <class T>
Form<T> choice(std::vector<std::pair<std::string, T>> options, std::vector<std::string> later = {}) {
  std::vector<std::string> names;
  for (const auto& [name, value] : options) names.push_back(name);
  const auto is_in = [](const std::vector<std::string>& list, const Value& v) {
    return v.is_scalar() && std::find(list.begin(), list.end(), v.text) != list.end();
  };
  Form<T> form;
  form.words = words_of_choice(names);
  form.json = json_of_choice(names);
  form.recognises = [=](const Value& v) { return is_in(names, v) || is_in(later, v); };
  form.read = [=](const Value& v, Reader& reader) -> std::optional<T> {
    for (const auto& [name, value] : options)
      if (v.is_scalar() && v.text == name) return value;
    if (is_in(later, v)) return reader.not_yet(v.text, v.place);
    return v.is_scalar() ? reader.unknown("value of " + reader.subject, v.text, v.place, names)
                         : reader.wrong(v, words_of_choice(names));
  };
  form.show = [=](const T& wanted) {
    for (const auto& [name, value] : options)
      if (value == wanted) return name;
    return std::string();
  };
  return form;
}

inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
std::string words_of_list(const std::string& item, std::size_t min, std::size_t max);
std::string json_of_list(const std::string& item, std::size_t min, std::size_t max);

/// A list whose items have one form.
template <class T>
Form<std::vector<T>> list_of(const Form<T>& item, std::size_t min = 0, std::size_t max = no_limit) {
  Form<std::vector<T>> form;
  form.words = words_of_list(item.words, min, max);
  form.json = json_of_list(item.json, min, max);
  form.recognises = [](const Value& v) { return v.kind == Value::Kind::List; };
  form.read = [item, min, max, words = form.words](const Value& v, Reader& reader) -> std::optional<std::vector<T>> {
    if (v.kind != Value::Kind::List || v.items.size() < min || v.items.size() > max)
      return reader.wrong(v, words, v.kind == Value::Kind::List && v.items.empty() ? "the list must not be empty" : "");
    std::vector<T> read;
    for (std::size_t i = 0; i < v.items.size(); ++i) {
      const Subject subject(reader, item_of(reader.subject, i));
      if (auto one = item.read(v.items[i], reader)) read.push_back(*std::move(one));
    }
    return read.size() == v.items.size() ? std::optional(std::move(read)) : std::nullopt;
  };
  return form;
}

/// The first of `forms` that recognises the value reads it.
template <class T>
Form<T> either(const std::vector<Form<T>>& forms, std::string words = {}) {
  Form<T> form;
  std::string any;
  for (const Form<T>& one : forms) {
    if (one.json.empty()) continue;
    form.words += (form.words.empty() ? "" : ", or ") + one.words;
    any += (any.empty() ? "" : ",") + one.json;
    if (!form.show) form.show = one.show;
  }
  if (!words.empty()) form.words = words;
  form.json = "{\"anyOf\":[" + any + "]}";
  form.recognises = [forms](const Value& v) {
    for (const Form<T>& one : forms)
      if (one.recognises(v)) return true;
    return false;
  };
  form.read = [forms, all = form.words](const Value& v, Reader& reader) -> std::optional<T> {
    for (const Form<T>& one : forms)
      if (one.recognises(v)) return one.read(v, reader);
    return reader.wrong(v, all);
  };
  return form;
}

/// The same text, another type.
template <class To, class From, class Convert>
Form<To> mapped(const Form<From>& from, Convert convert) {
  return {.words = from.words,
          .json = from.json,
          .read = [from, convert](const Value& v, Reader& reader) -> std::optional<To> {
            auto value = from.read(v, reader);
            if (!value) return std::nullopt;
            return To(convert(*std::move(value)));
          },
          .recognises = from.recognises};
}

/// A form with one more condition, which no schema can say.
template <class T, class Condition>
Form<T> checked(Form<T> form, Condition holds, std::string words) {
  form.words = std::move(words);
  form.read = [read = form.read, holds, all = form.words](const Value& v, Reader& reader) -> std::optional<T> {
    auto value = read(v, reader);
    if (value && !holds(*value)) return reader.wrong(v, all);
    return value;
  };
  return form;
}

}  // namespace marrow
