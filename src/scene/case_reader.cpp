// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "meltray/core/nearest.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/optics.hpp"
#include "scene/case_check.hpp"
#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

/// Calls f(key, index, path) for every key of the scene.
template <class F>
void for_each_key(const Scene& scene, F&& f) {
  for (const Key& key : all_keys())
    for (int i = 0; i < count_of(key, scene); ++i) f(key, i, path_of(key, i));
}

/// Terms that are not smooth or have no stiff part: they have no entry in [splitting].
constexpr std::array<std::string_view, 11> kAlwaysExplicit = {
    "pressure", "surface_tension", "marangoni",           "wetting", "recoil", "laser", "buoyancy", "gravity",
    "melting",  "radiation",       "artificial_viscosity"};

void refuse_fixed_splitting(const Entry& entry) {
  constexpr std::string_view prefix = "splitting.";
  if (!entry.path.starts_with(prefix)) return;
  const std::string_view name = std::string_view(entry.path).substr(prefix.size());
  if (std::find(kAlwaysExplicit.begin(), kAlwaysExplicit.end(), name) == kAlwaysExplicit.end()) return;
  const char* why = name == "radiation"  ? "the term follows splitting.evaporation"
                    : name == "pressure" ? "pressure is projected: splitting.projection"
                                         : "the term is not smooth and always explicit";
  refuse(entry.place, entry.path, describe(entry.value), fmt::format("no choice: {}", why));
}

/// Keys of the same section, else the sections.
std::string known_beside(const std::string& path, const std::set<std::string>& known) {
  const auto dot = path.rfind('.');
  const std::string section = dot == std::string::npos ? std::string() : path.substr(0, dot + 1);
  std::vector<std::string> names;
  for (const std::string& candidate : known) {
    if (!candidate.starts_with(section)) continue;
    const std::string rest = candidate.substr(section.size());
    if (rest.find('.') == std::string::npos) names.push_back(rest);
  }
  if (names.empty() && path.starts_with("faces."))
    return fmt::format("the faces {}", fmt::join(face_names(), ", "));
  if (names.empty() || section.empty())
    return "title, include, model, [domain], [faces.*], [[bodies]], [material], [terms], [flow], [surface], "
           "[heat], [laser], [time], [splitting], [output]";
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The same name in another section is nearer than a similar name in the same one.
std::string nearest_path(const std::string& path, const std::set<std::string>& known) {
  const auto name_of = [](const std::string& p) { return p.substr(p.rfind('.') + 1); };
  const std::string name = name_of(path);
  std::string best;
  std::size_t best_score = std::max<std::size_t>(3, name.size() / 2) + 1, best_distance = 0;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(path, candidate);
    const std::size_t score = name_of(candidate) == name ? std::min<std::size_t>(distance, 1) : distance;
    if (score < best_score || (score == best_score && distance < best_distance)) {
      best = candidate;
      best_score = score;
      best_distance = distance;
    }
  }
  return best;
}

/// "bodies.0.shape" has to name a body that is there; [bodies] instead of [[bodies]] has no number at all.
void check_body_number(const std::string& path, const Place& place, int bodies) {
  constexpr std::string_view prefix = "bodies.";
  if (!path.starts_with(prefix)) return;
  const std::string number = path.substr(prefix.size(), path.find('.', prefix.size()) - prefix.size());
  const bool digits = !number.empty() && number.size() < 9 &&
                      std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits)
    refuse(place, path, fmt::format("'{}' in place of the number of a body", number),
           "sections [[bodies]] in double brackets");
  if (std::stoi(number) >= bodies)
    refuse(place, "bodies." + number, fmt::format("body '{}' of {}", number, bodies),
           bodies ? fmt::format("0 to {}", bodies - 1) : "[[bodies]] sections");
}

void check_names(const Document& document, const Scene& scene) {
  std::set<std::string> known = {"include", "resolved"}, sections = {"faces", "bodies", "laser"};
  for_each_key(scene, [&](const Key&, int, const std::string& path) { known.insert(path); });
  for (const Key& key : all_keys())  // a scene without a laser or bodies knows their keys as well
    if (count_of(key, scene) == 0) known.insert(path_of(key, 0));
  for (const std::string& path : known)
    if (path.find('.') != std::string::npos) sections.insert(path.substr(0, path.rfind('.')));
  for (const auto& [path, entry] : document.entries) {
    check_body_number(path, entry.place, document.bodies);
    if (known.contains(path)) continue;
    if (sections.contains(path))
      refuse(entry.place, path, describe(entry.value),
             path == "bodies" ? "tables: [[bodies]]" : fmt::format("a table: [{}]", path));
    refuse_fixed_splitting(entry);
    refuse(entry.place, path, "an unknown key", known_beside(path, known), nearest_path(path, known));
  }
  for (const auto& [path, place] : document.tables) {
    check_body_number(path, place, document.bodies);
    if (sections.contains(path)) continue;
    if (known.contains(path)) {
      const auto& keys = all_keys();
      const auto it = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.path == path; });
      refuse(place, path, "a table", it == keys.end() ? "a value" : it->allowed());
    }
    refuse(place, path, "an unknown section", known_beside(path, sections), nearest_path(path, sections));
  }
}

/// Keys that were given in the scene's own words.
void assign_given(const Document& document, Scene& scene) {
  for_each_key(scene, [&](const Key& key, int i, const std::string& path) {
    const Entry* entry = document.find(path);
    if (!entry) return;
    try {
      assign(key, scene, i, *entry);
    } catch (const Refusal& r) {
      refuse(entry->place, path, r.found, r.allowed, r.nearest);
    }
  });
}

void derive_defaults(const Document& document, Scene& scene) {
  for_each_key(scene, [&](const Key& key, int i, const std::string& path) {
    if (key.derive && !document.given(path)) key.derive(scene, i, document);
  });
  if (scene.laser) {
    const auto index = laser_index(scene);
    scene.laser->trace.index_solid = index.solid;
    scene.laser->trace.index_liquid = index.liquid;
  }
}

/// The keys that decide, with the name of the face or the number of the body.
std::vector<std::string> keys_of(const Need& need, int index) {
  std::vector<std::string> keys;
  for (const std::string& key : need.keys) keys.push_back(path_of(key, index));
  return keys;
}

void check_presence(const Document& document, const Scene& scene) {
  for_each_key(scene, [&](const Key& key, int i, const std::string& path) {
    const Need* lacking = key.inactive(scene, i);
    const Entry* entry = document.find(path);
    if (entry && lacking && !document.may_be_idle(path, keys_of(*lacking, i)))
      refuse(entry->place, path, fmt::format("{}, which has no effect here", describe(entry->value)),
             "this key only with " + lacking->text);
    if (!entry && !lacking && key.is_required)
      refuse(document.place(path), path, "nothing: the key is missing", key.allowed());
  });
}

void check_top(const Document& document) {
  const Entry* resolved = document.find("resolved");
  if (resolved && !std::holds_alternative<bool>(resolved->value.data))
    refuse(resolved->place, "resolved", describe(resolved->value), "true or false");
}

/// A row of Table 1 and a material fill keys that are not given; in a resolved case all of them are.
void refuse_defaults_of_resolved(const Document& document) {
  if (document.resolved.empty()) return;
  for (const char* path : {"model", "material.name"})
    if (const Entry* entry = document.find(path); entry && entry->layer > *document.resolved.begin())
      refuse(entry->place, path,
             fmt::format("{} over a resolved case, which gives every key that it would fill",
                         describe(entry->value)),
             "the keys themselves, or the case file that the resolved one was made of");
}

Scene build(const Document& document) {
  Scene scene;
  scene.domain.bodies.resize(static_cast<std::size_t>(document.bodies));
  const auto first = document.entries.lower_bound("laser.");
  const bool has_key = first != document.entries.end() && first->first.starts_with("laser.");
  if (has_key || document.tables.contains("laser")) scene.laser.emplace();
  check_top(document);
  refuse_defaults_of_resolved(document);
  check_names(document, scene);
  assign_given(document, scene);
  derive_defaults(document, scene);
  check_presence(document, scene);
  check_geometry(scene, document);
  check_material(scene, document);
  check_terms(scene, document);
  check_flow(scene, document);
  check_elastic(scene, document);
  check_time(scene, document);
  check_laser(scene, document);
  return scene;
}

}  // namespace

std::string case_title(const std::filesystem::path& file) {
  const Document document = load_document(file, {}, is_table_value);
  const Entry* title = document.find("title");
  return title && title->value.text() ? *title->value.text() : std::string();
}

Scene read_case(const std::filesystem::path& file, const Overrides& overrides) {
  return build(load_document(file, overrides, is_table_value));
}

Scene read_case_text(const std::string& text, const std::string& name, const Overrides& overrides) {
  return build(parse_document(text, name, overrides, is_table_value));
}

}  // namespace meltray::scene
