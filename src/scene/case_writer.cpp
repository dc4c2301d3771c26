// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "meltray/scene/case_file.hpp"
#include "scene/keys.hpp"

namespace meltray::scene {

namespace {

constexpr const char* kHeader =
    "# Resolved case: every key with its value, defaults included.\n"
    "# `resolved` lets keys stand that have no effect here (marked below); remove it to have them reported.\n"
    "resolved = true\n";

/// Keys of another shape of body, of a face that a 2-D scene does not have, or of a property that the
/// material does not have, are left out: they have no value.
bool is_written(const Key& key, const Scene& scene, int index) {
  const Need* lacking = key.inactive(scene, index);
  const bool no_face =
      key.path.starts_with("faces.") && scene.domain.dimension == 2 && (index == 2 || index == 3);
  if (no_face || (lacking && key.is_required)) return false;
  const Value value = key.get(scene, index);
  return !value.is_number() || key.range.contains(value.number());
}

std::string line(const Key& key, const Scene& scene, int index, bool comments) {
  std::string text = fmt::format("{} = {}", key.name(), to_toml(key.get(scene, index)));
  if (key.is_alias) text = "# " + text;
  if (!comments) return text + "\n";
  std::string comment = key.sentence;
  if (!key.unit.empty()) comment = fmt::format("[{}] {}", key.unit, comment);
  if (const Need* lacking = key.inactive(scene, index))
    comment += fmt::format(" (No effect here: needs {}.)", lacking->text);
  return fmt::format("{:<36} # {}\n", text, comment);
}

std::string write_keys(const Scene& scene, bool comments) {
  std::string out;
  const auto& keys = all_keys();
  for (auto first = keys.begin(); first != keys.end();) {
    const std::string section = first->section();
    const auto last =
        std::find_if(first, keys.end(), [&](const Key& key) { return key.section() != section; });
    for (int i = 0; i < count_of(*first, scene); ++i) {
      std::string lines;
      for (auto key = first; key != last; ++key)
        if (is_written(*key, scene, i)) lines += line(*key, scene, i, comments);
      if (lines.empty()) continue;
      if (section == "bodies.*")
        out += "\n[[bodies]]\n";
      else if (!section.empty())
        out += fmt::format("\n[{}]\n", path_of(section, i));
      out += lines;
    }
    first = last;
  }
  return out;
}

}  // namespace

std::string write_case(const Scene& scene) {
  return kHeader + write_keys(scene, true);
}

std::string case_values(const Scene& scene) {
  return write_keys(scene, false);
}

}  // namespace meltray::scene
