// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "meltray/scene/scene.hpp"
#include "scene/case_document.hpp"

namespace meltray::scene {

/// What is wrong with a value; the reader adds file, line and key.
struct Refusal {
  std::string found, allowed, nearest;
};

/// Numbers a key takes.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool open_low = false;  ///< `low` itself is not allowed

  bool contains(double x) const { return (open_low ? x > low : x >= low) && x <= high; }
  std::string text() const;  ///< "> 0", "from 0 to 1"; empty: any
};
inline Range any() {
  return {};
}
inline Range above(double low) {
  return {.low = low, .open_low = true};
}
inline Range at_least(double low) {
  return {.low = low};
}
inline Range between(double low, double high) {
  return {.low = low, .high = high};
}
inline Range above_to(double low, double high) {
  return {low, high, true};
}

/// A condition under which a key has an effect. A key that is given without it is refused, because a value
/// that does nothing is a misunderstanding; unless a later layer (an including file, --set) switched it off
/// on purpose.
struct Need {
  std::string text;               ///< "terms.conduction = true"
  std::vector<std::string> keys;  ///< that decide; "*" is the face or body of the key itself
  std::function<bool(const Scene&, int)> holds;
};

enum class Kind { boolean, integer, number, word, text, vector, property, power_table };

/// One key of the case file: the only source of reading, checks, default, resolved case and reference page.
/// `index` of the bindings is the face (faces.*), the body (bodies.*) or 0.
struct Key {
  std::string path;  ///< "laser.power_w", "faces.*.kind", "bodies.*.shape"
  Kind kind = Kind::number;
  std::string unit;  ///< empty: none
  std::string sentence;
  Range range = {};
  std::vector<std::string> words = {};  ///< allowed words; for a number: words it takes as well
  int entries = 0;                      ///< of a vector; 0: as many as the scene has dimensions
  bool is_required = false;             ///< where all needs hold
  bool is_alias = false;                ///< another way to write part of another key: not in resolved cases
  std::vector<Need> needs = {};
  std::string default_text = {};  ///< of a default that depends on other keys
  std::function<Value(const Scene&, int)> get = {};
  std::function<void(Scene&, int, const Value&)> set = {};
  /// Default that depends on other keys; called after all given keys are set.
  std::function<void(Scene&, int, const Document&)> derive = {};

  Key required() const;
  Key alias() const;
  Key only_if(Need need) const;
  Key otherwise(std::string text, std::function<void(Scene&, int, const Document&)> rule) const;

  std::string section() const;  ///< "laser", "faces.*"; empty at the top level
  std::string name() const;     ///< last part of the path
  std::string allowed() const;  ///< "number > 0 [m]", "gaussian, top_hat"
  /// First need that does not hold; null when the key has an effect.
  const Need* inactive(const Scene& scene, int index) const;
};

/// All keys in the order of the resolved case.
const std::vector<Key>& all_keys();
/// Path with "*" replaced by the name of the face or the number of the body.
std::string path_of(const Key& key, int index);
std::string path_of(std::string_view pattern, int index);
/// How often a key occurs in a scene: 6 for faces.*, the number of bodies for bodies.*, else 1 (laser: 0 or
/// 1).
int count_of(const Key& key, const Scene& scene);
/// True where a table is the value of one key (a property given as a formula).
bool is_table_value(std::string_view path);
/// Checks type and range of a value and stores it. Throws Refusal.
void assign(const Key& key, Scene& scene, int index, const Entry& entry);

const std::vector<std::string>& face_names();

/// The sections, in keys_*.cpp.
std::vector<Key> domain_keys();
std::vector<Key> face_keys();
std::vector<Key> body_keys();
std::vector<Key> material_keys();
std::vector<Key> term_keys();
std::vector<Key> solver_keys();
std::vector<Key> elastic_keys();
std::vector<Key> flow_keys();
std::vector<Key> surface_keys();
std::vector<Key> heat_keys();
std::vector<Key> laser_keys();
std::vector<Key> time_keys();
std::vector<Key> output_keys();

}  // namespace meltray::scene
