// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "meltray/scene/case_file.hpp"
#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

/// A vertical bar would end the cell.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

const char* type_of(const Key& key) {
  switch (key.kind) {
    case Kind::boolean:
      return "boolean";
    case Kind::integer:
      return "integer";
    case Kind::number:
      return key.words.empty() ? "number" : "number or word";
    case Kind::word:
      return "word";
    case Kind::text:
      return "text";
    case Kind::vector:
      return "array";
    case Kind::property:
      return "number or table";
    case Kind::power_table:
      return "path or array";
  }
  return "";
}

std::string default_of(const Key& key, const Scene& defaults) {
  if (key.is_required) return "required";
  if (!key.default_text.empty()) return key.default_text;
  return fmt::format("`{}`", to_toml(key.get(defaults, 0)));
}

std::string needs_of(const Key& key) {
  std::string text;
  for (const Need& need : key.needs) text += (text.empty() ? "" : "; ") + need.text;
  return text;
}

std::string title_of(const std::string& section) {
  if (section.empty()) return "Top level";
  if (section == "bodies.*") return "[[bodies]]";
  if (section == "faces.*") return "[faces.x_min], x_max, y_min, y_max, z_min, z_max";
  return "[" + section + "]";
}

}  // namespace

std::string key_reference() {
  std::string out =
      "# Keys of a case file\n\n"
      "SI units; the unit is part of the name. An unknown key is an error, and so is a key that has no "
      "effect in "
      "its scene (last column). Files named by `include` are read first; keys of the including file, then "
      "`--set`, "
      "override them. A list of bodies replaces the one of the base as a whole; `--set "
      "bodies.0.temperature_k=500` "
      "changes one body.\n\n"
      "A property of a material is a number or a formula of the temperature T: `linear`, value + slope (T - "
      "reference_k), or `andrade`, 10^(a + b_k / T). It is held at its end values outside min_k to max_k, "
      "which may "
      "be left out. A `[laser]` needs `domain.dimension = 3`.\n";
  Scene defaults;
  defaults.domain.bodies.emplace_back();
  defaults.laser.emplace();
  std::string section = "-";
  for (const Key& key : all_keys()) {
    if (key.section() != section) {
      section = key.section();
      out += fmt::format(
          "\n## {}\n\n| key | type | unit | default | allowed | meaning | only with "
          "|\n|---|---|---|---|---|---|---|\n",
          title_of(section));
      if (section.empty())
        out +=
            "| `include` | path or array | | none | paths relative to this file | Case files that this one "
            "builds on. | |\n"
            "| `resolved` | boolean | | `false` | true or false | Written by Meltray: the file holds every "
            "key, also "
            "those without effect. | |\n";
    }
    out += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", key.name(), type_of(key), cell(key.unit),
                       cell(default_of(key, defaults)), cell(key.allowed()), cell(key.sentence),
                       cell(needs_of(key)));
  }
  return out;
}

}  // namespace meltray::scene
