// SPDX-License-Identifier: MIT
#include "scene/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "meltray/core/nearest.hpp"
#include "meltray/scene/presets.hpp"
#include "scene/keys_build.hpp"
#include "scene/power_table.hpp"
#include "scene/property_value.hpp"

namespace meltray::scene {

namespace {

std::string with_unit(std::string text, const std::string& unit) {
  return unit.empty() ? text : fmt::format("{} [{}]", text, unit);
}

std::string number_words(const char* what, const Key& key) {
  const std::string range = key.range.text();
  return with_unit(range.empty() ? what : fmt::format("{} {}", what, range), key.unit);
}

Refusal refusal(const Key& key, const Value& value) {
  return {describe(value), key.allowed(), {}};
}

Refusal unknown_word(const Key& key, const Value& value) {
  const std::string* text = value.text();
  return {describe(value), key.allowed(), text ? nearest_name(*text, key.words) : std::string()};
}

void check_number(const Key& key, const Value& value, const Value& whole) {
  if (!value.is_number()) throw refusal(key, whole);
  const double x = value.number();
  if (!std::isfinite(x)) throw Refusal{describe(whole), "finite numbers: " + key.allowed(), {}};
  if (!key.range.contains(x)) throw refusal(key, whole);
}

bool is_word_of(const Key& key, const Value& value) {
  const std::string* text = value.text();
  return text && std::find(key.words.begin(), key.words.end(), *text) != key.words.end();
}

void check(const Key& key, const Scene& scene, const Value& value) {
  switch (key.kind) {
    case Kind::boolean:
      if (!std::holds_alternative<bool>(value.data)) throw refusal(key, value);
      break;
    case Kind::integer:
      if (!std::holds_alternative<std::int64_t>(value.data)) throw refusal(key, value);
      check_number(key, value, value);
      break;
    case Kind::number:
      if (is_word_of(key, value)) break;
      if (value.text() && !key.words.empty()) throw unknown_word(key, value);
      check_number(key, value, value);
      break;
    case Kind::word:
      if (!is_word_of(key, value)) throw unknown_word(key, value);
      break;
    case Kind::text:
      if (!value.text()) throw refusal(key, value);
      break;
    case Kind::vector: {
      const std::size_t entries =
          static_cast<std::size_t>(key.entries ? key.entries : scene.domain.dimension);
      if (!value.array()) throw refusal(key, value);
      if (value.array()->size() != entries)
        throw Refusal{fmt::format("{} with {} entries", describe(value), value.array()->size()),
                      fmt::format("{} entries: {}", entries, key.allowed()),
                      {}};
      for (const Value& item : *value.array()) check_number(key, item, value);
      break;
    }
    case Kind::property:
    case Kind::power_table:
      break;  // read and checked as a whole by assign()
  }
}

std::vector<Key> top_keys() {
  Key title{.path = "title", .kind = Kind::text, .unit = "", .sentence = "One line about the case."};
  title.get = [](const Scene& s, int) { return Value{s.title}; };
  title.set = [](Scene& s, int, const Value& v) { s.title = *v.text(); };
  Key model{.path = "model",
            .kind = Kind::word,
            .unit = "",
            .sentence =
                "Row of the paper's Table 1: sets solver, numerical viscosity, expansion, buoyancy, "
                "solid and shifting where their keys are not given."};
  for (const Preset& p : presets()) model.words.emplace_back(p.model);
  model.get = [](const Scene& s, int) { return Value{s.model}; };
  model.set = [](Scene& s, int, const Value& v) { s.model = *v.text(); };
  return {title, model};
}

}  // namespace

std::string Range::text() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high)
    return open_low ? fmt::format("> {} and <= {}", low, high) : fmt::format("from {} to {}", low, high);
  if (has_low) return fmt::format("{} {}", open_low ? ">" : ">=", low);
  if (has_high) return fmt::format("<= {}", high);
  return "";
}

Key Key::required() const {
  Key k = *this;
  k.is_required = true;
  return k;
}

Key Key::alias() const {
  Key k = *this;
  k.is_alias = true;
  return k;
}

Key Key::only_if(Need need) const {
  Key k = *this;
  k.needs.push_back(std::move(need));
  return k;
}

Key Key::otherwise(std::string text, std::function<void(Scene&, int, const Document&)> rule) const {
  Key k = *this;
  k.default_text = std::move(text);
  k.derive = std::move(rule);
  return k;
}

std::string Key::section() const {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? std::string() : path.substr(0, dot);
}

std::string Key::name() const {
  return path.substr(path.rfind('.') + 1);
}

std::string Key::allowed() const {
  switch (kind) {
    case Kind::boolean:
      return "true or false";
    case Kind::integer:
      return number_words("an integer", *this);
    case Kind::number: {
      const std::string numbers = number_words("a number", *this);
      return words.empty() ? numbers : fmt::format("{} or \"{}\"", numbers, fmt::join(words, "\", \""));
    }
    case Kind::word:
      return fmt::format("\"{}\"", fmt::join(words, "\", \""));
    case Kind::text:
      return "text in quotes";
    case Kind::vector:
      return number_words(
          entries == 2 ? "an array of 2 numbers" : "an array [x, y, z] (2-D: [x, z]) of numbers", *this);
    case Kind::property:
      return property_forms(range, unit);
    case Kind::power_table:
      return "the path of a CSV file with columns time_s,power_w, or an array of [time, power]";
  }
  return "";
}

const Need* Key::inactive(const Scene& scene, int index) const {
  for (const Need& need : needs)
    if (!need.holds(scene, index)) return &need;
  return nullptr;
}

const std::vector<std::string>& face_names() {
  static const std::vector<std::string> names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  return names;
}

const std::vector<Key>& all_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (auto section :
         {top_keys, domain_keys, face_keys, body_keys, material_keys, term_keys, solver_keys, elastic_keys,
          flow_keys, surface_keys, heat_keys, laser_keys, time_keys, output_keys})
      append(all, section());
    return all;
  }();
  return keys;
}

std::string path_of(std::string_view pattern, int index) {
  const auto star = pattern.find('*');
  if (star == std::string_view::npos) return std::string(pattern);
  const std::string which =
      pattern.starts_with("faces.") ? face_names()[static_cast<std::size_t>(index)] : std::to_string(index);
  return std::string(pattern.substr(0, star)) + which + std::string(pattern.substr(star + 1));
}

std::string path_of(const Key& key, int index) {
  return path_of(key.path, index);
}

int count_of(const Key& key, const Scene& scene) {
  if (key.path.starts_with("faces.")) return 6;
  if (key.path.starts_with("bodies.")) return static_cast<int>(scene.domain.bodies.size());
  if (key.path.starts_with("laser.")) return scene.laser ? 1 : 0;
  return 1;
}

bool is_table_value(std::string_view path) {
  const auto& keys = all_keys();
  return std::any_of(keys.begin(), keys.end(),
                     [&](const Key& k) { return k.kind == Kind::property && k.path == path; });
}

void assign(const Key& key, Scene& scene, int index, const Entry& entry) {
  check(key, scene, entry.value);
  if (key.kind == Kind::power_table)
    scene.laser->beam.table = read_power_table(entry, key.allowed());
  else
    key.set(scene, index, entry.value);
}

}  // namespace meltray::scene
