// Maps of the format as tables of keys, bound to the members of a description.
// A key is one entry; the entry reads it, puts it into the JSON Schema and into the reference.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "renderer/scene/form.h"

namespace marrow {

struct KeyInfo {
  std::string name, words, json, doc;
  std::string fallback;  ///< the value when the key is left out, as text; may be empty
  bool is_required = false;
};

struct TableInfo {
  std::string name, doc;
  std::vector<KeyInfo> keys;
  std::vector<std::string> exactly_one;  ///< keys of which one must be there
};

template <class Owner>
struct Key {
  KeyInfo info;
  std::function<bool(Owner&, const Value&, Reader&)> read;  ///< false after reporting a mistake

  Key required() && {
    info.is_required = true;
    info.fallback.clear();
    return std::move(*this);
  }
};

/// Checks that a map has only known keys, each required one, and one of `exactly_one`. False: it is no map.
bool check_members(const TableInfo&, const Value&, Reader&, bool& complete);

template <class Owner>
struct Table {
  TableInfo info;
  std::vector<Key<Owner>> keys;
  /// Conditions on several keys at once; false after reporting a mistake.
  std::function<bool(const Owner&, const Value&, Reader&)> check;

  Table(std::string name, std::string doc, std::vector<Key<Owner>> list,
        std::function<bool(const Owner&, const Value&, Reader&)> also = {})
      : info{.name = std::move(name), .doc = std::move(doc), .keys = {}, .exactly_one = {}},
        keys(std::move(list)),
        check(std::move(also)) {
    for (const Key<Owner>& key : keys) info.keys.push_back(key.info);
  }

  /// Keys are read in the order of the table.
  std::optional<Owner> read(const Value& v, Reader& reader) const {
    bool complete = true;
    if (!check_members(info, v, reader, complete)) return std::nullopt;
    Owner owner{};
    for (const Key<Owner>& key : keys) {
      const Member* member = v.find(key.info.name);
      if (!member) continue;
      const Subject subject(reader, "`" + key.info.name + "`");
      if (!key.read(owner, member->value, reader)) complete = false;
    }
    if (!complete || (check && !check(owner, v, reader))) return std::nullopt;
    return owner;
  }
};

/// A key whose value goes to `target`: a member of the owner (or of one of its bases), or a function (Owner&, T).
template <class Owner, class T, class Target>
Key<Owner> key(std::string name, Target target, const Form<T>& form, std::string doc) {
  Key<Owner> made;
  made.info = {.name = std::move(name), .words = form.words, .json = form.json, .doc = std::move(doc), .fallback = {}};
  constexpr bool is_function = std::is_invocable_v<Target, Owner&, T>;
  if constexpr (!is_function) {
    if constexpr (std::is_same_v<std::decay_t<decltype(std::invoke(target, std::declval<Owner&>()))>, T>)
      if (form.show) made.info.fallback = form.show(std::invoke(target, Owner{}));
  }
  made.read = [form, target](Owner& owner, const Value& v, Reader& reader) {
    auto value = form.read(v, reader);
    if (!value) return false;
    if constexpr (is_function) std::invoke(target, owner, *std::move(value));
    else std::invoke(target, owner) = *std::move(value);
    return true;
  };
  return made;
}

/// The JSON Schema fragment that stands for a definition.
std::string reference_to(const std::string& definition);

/// A map with the keys of a table, which must outlive the form.
template <class Owner>
Form<Owner> map_of(const Table<Owner>& table) {
  return {.words = "a map of " + table.info.name,
          .json = reference_to(table.info.name),
          .read = [&table](const Value& v, Reader& reader) { return table.read(v, reader); },
          .recognises = [](const Value& v) { return v.kind == Value::Kind::Map; }};
}

struct AlternativesInfo {
  std::string name, doc;
  struct One {
    std::string name, json, words;
  };
  std::vector<One> list;
  std::vector<std::string> later;  ///< names of the format that this version does not render
};

/// A map of one key, which says what the value is: `point: {...}`.
template <class T>
struct Alternatives {
  AlternativesInfo info;
  std::vector<Form<T>> forms;

  Alternatives(std::string name, std::string doc, std::vector<std::pair<std::string, Form<T>>> list,
               std::vector<std::string> later = {})
      : info{.name = std::move(name), .doc = std::move(doc), .list = {}, .later = std::move(later)} {
    for (auto& [key, form] : list) {
      info.list.push_back({key, form.json, form.words});
      forms.push_back(std::move(form));
    }
  }

  std::optional<T> read(const Value&, Reader&) const;
};

/// Index of the alternative that the one key of a map names; nothing after reporting what is wrong with it.
std::optional<std::size_t> find_alternative(const AlternativesInfo&, const Value&, Reader&);

template <class T>
std::optional<T> Alternatives<T>::read(const Value& v, Reader& reader) const {
  const auto index = find_alternative(info, v, reader);
  if (!index) return std::nullopt;
  const Subject subject(reader, "`" + info.list[*index].name + "`");
  return forms[*index].read(v.members[0].value, reader);
}

template <class T>
Form<T> one_of(const Alternatives<T>& alternatives) {
  return {.words = "a " + alternatives.info.name,
          .json = alternatives.info.list.empty() ? "" : reference_to(alternatives.info.name),
          .read = [&alternatives](const Value& v, Reader& reader) { return alternatives.read(v, reader); },
          .recognises = [](const Value& v) { return v.kind == Value::Kind::Map; }};
}

template <class T>
struct Named {
  std::string name;
  T what;
  Place place;
};

/// A map from names to values of one form, which must outlive it.
template <class T>
Form<std::vector<Named<T>>> names_of(const Form<T>& item) {
  Form<std::vector<Named<T>>> form;
  form.words = "a map from names to " + item.words;
  form.json = "{\"type\":\"object\",\"additionalProperties\":" + item.json + "}";
  form.recognises = [](const Value& v) { return v.kind == Value::Kind::Map; };
  form.read = [item, words = form.words](const Value& v, Reader& reader) -> std::optional<std::vector<Named<T>>> {
    if (v.kind != Value::Kind::Map) return reader.wrong(v, words);
    std::vector<Named<T>> read;
    for (const Member& member : v.members) {
      const Subject subject(reader, "`" + member.key + "`");
      if (auto one = item.read(member.value, reader)) read.push_back({member.key, *std::move(one), member.place});
    }
    return read.size() == v.members.size() ? std::optional(std::move(read)) : std::nullopt;
  };
  return form;
}

}  // namespace marrow
