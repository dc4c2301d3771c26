// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/case_value.hpp"

namespace meltray::scene {

/// Where a key was given; line 0: on the command line, `file` is then "--set".
struct Place {
  std::string file;
  int line = 0;
};

/// Throws UsageError "<file>:<line>: <key>: found <found>; allowed <allowed>[; did you mean '<nearest>'?]".
[[noreturn]] void refuse(const Place& place, std::string_view key, std::string_view found,
                         std::string_view allowed, std::string_view nearest = {});

struct Entry {
  std::string path;  ///< "laser.power_w", "faces.x_min.kind", "bodies.0.shape"
  Value value;
  Place place;
  int layer = 0;                 ///< files count up from the innermost include; --set comes last
  std::filesystem::path folder;  ///< that paths inside the value are relative to
};

/// Tells the document which tables are values of one key and not sections.
using IsTableValue = bool (*)(std::string_view path);

/// A case file with its includes and overrides, flattened to "path = value"; nothing is known about keys
/// here.
struct Document {
  std::string name;  ///< of the outermost file, for messages
  std::map<std::string, Entry> entries;
  std::map<std::string, Place> tables;  ///< every section that was opened
  std::set<int> resolved;               ///< layers that say `resolved = true`
  int bodies = 0;                       ///< length of [[bodies]]

  const Entry* find(std::string_view path) const;
  bool given(std::string_view path) const { return find(path) != nullptr; }
  /// Of the key, else of its section, else the first line of the file.
  Place place(std::string_view path) const;
  /// Layer of a key; 0 where it was not given.
  int layer(std::string_view path) const;
  /// Whether a given key may stand without effect: in a resolved case, which gives every key, or where a
  /// later layer gave one of those that decide, so that it was switched off on purpose.
  bool may_be_idle(std::string_view path, const std::vector<std::string>& decided_by) const;
};

Document load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                       IsTableValue is_table_value);
Document parse_document(const std::string& text, const std::string& name,
                        const std::vector<std::string>& overrides, IsTableValue is_table_value);

}  // namespace meltray::scene
