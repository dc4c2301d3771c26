// SPDX-License-Identifier: MIT
#include "scene/case_document.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "meltray/core/errors.hpp"

namespace meltray::scene {

namespace {

namespace fs = std::filesystem;

std::string at(const Place& place) {
  return place.line > 0 ? fmt::format("{}:{}", place.file, place.line) : place.file;
}

Value convert(const toml::node& node) {
  if (const auto* b = node.as_boolean()) return {b->get()};
  if (const auto* i = node.as_integer()) return {i->get()};
  if (const auto* x = node.as_floating_point()) return {x->get()};
  if (const auto* s = node.as_string()) return {s->get()};
  if (const auto* a = node.as_array()) {
    Array out;
    for (const toml::node& item : *a) out.push_back(convert(item));
    return {std::move(out)};
  }
  if (const auto* t = node.as_table()) {
    Table out;
    for (const auto& [name, item] : *t) {
      out.names.emplace_back(name.str());
      out.values.push_back(convert(item));
    }
    return {std::move(out)};
  }
  return {OtherType{"a date or time"}};
}

/// A quoted key with a dot in it is one name, not a path.
std::string segment(std::string_view name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return bare ? std::string(name) : fmt::format("\"{}\"", name);
}

/// The content of one file (or one --set), flattened.
struct Flat {
  std::vector<Entry> entries;
  std::map<std::string, Place> tables;
  int bodies = -1;  ///< length of an array of tables named "bodies"; -1: there is none
};

class Flattener {
 public:
  Flattener(std::string file, int layer, fs::path folder, IsTableValue is_table_value)
      : file_(std::move(file)), layer_(layer), folder_(std::move(folder)), is_table_value_(is_table_value) {}

  Flat run(const toml::table& root) {
    descend(root, "");
    return std::move(flat_);
  }

 private:
  Place place(const toml::node& node) const {
    return {file_, layer_ < 0 ? 0 : static_cast<int>(node.source().begin.line)};
  }

  void descend(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + segment(key.str());
      const auto* inner = node.as_table();
      const auto* list = node.as_array();
      const bool list_of_tables = list && !list->empty() && list->is_homogeneous<toml::table>();
      if (is_table_value_(path) || (!inner && !list_of_tables)) {
        flat_.entries.push_back({path, convert(node), place(node), layer_, folder_});
      } else if (inner) {
        flat_.tables[path] = place(node);
        descend(*inner, path + ".");
      } else {
        if (path == "bodies") flat_.bodies = static_cast<int>(list->size());
        for (std::size_t k = 0; k < list->size(); ++k) {
          const std::string item = fmt::format("{}.{}", path, k);
          flat_.tables[item] = place((*list)[k]);
          descend(*(*list)[k].as_table(), item + ".");
        }
      }
    }
  }

  std::string file_;
  int layer_;
  fs::path folder_;
  IsTableValue is_table_value_;
  Flat flat_;
};

class Loader {
 public:
  explicit Loader(IsTableValue is_table_value) : is_table_value_(is_table_value) {}

  void file(const fs::path& path, const Place& from) {
    const fs::path identity = fs::weakly_canonical(path);
    if (const auto seen = std::find(open_.begin(), open_.end(), identity); seen != open_.end()) {
      std::string chain;
      for (auto it = seen; it != open_.end(); ++it) chain += it->filename().string() + " -> ";
      refuse(from, "include", fmt::format("a cycle: {}{}", chain, identity.filename().string()),
             "files that do not include themselves");
    }
    std::ifstream stream(path);
    std::error_code ignored;
    if (!stream || fs::is_directory(path, ignored)) {
      const char* what = fs::is_directory(path, ignored) ? "a folder"
                         : fs::exists(path, ignored)     ? "a file that cannot be opened"
                                                         : "no such file";
      if (from.line > 0)
        refuse(from, "include", fmt::format("{} at '{}'", what, path.string()), "a readable case file");
      throw UsageError(fmt::format("{}: found {}; allowed a readable case file", path.string(), what));
    }
    std::ostringstream text;
    text << stream.rdbuf();
    open_.push_back(identity);
    parse(text.str(), path.string(), path.parent_path());
    open_.pop_back();
  }

  void parse(const std::string& text, const std::string& name, const fs::path& folder) {
    toml::table root;
    try {
      root = toml::parse(text, name);
    } catch (const toml::parse_error& e) {
      throw UsageError(fmt::format("{}:{}: TOML syntax: {}", name, e.source().begin.line, e.description()));
    }
    includes(root, name, folder);
    ++layer_;
    Flat flat = Flattener(name, layer_, folder, is_table_value_).run(root);
    if (const auto resolved = root["resolved"].value_exact<bool>(); resolved && *resolved)
      document_.resolved.insert(layer_);
    merge(std::move(flat));
  }

  void overrides(const std::vector<std::string>& texts) {
    Flat all;
    for (const std::string& text : texts) {
      Flat one = Flattener("--set", -1, {}, is_table_value_).run(parse_override(text));
      for (Entry& entry : one.entries) {
        const auto same = [&](const Entry& e) { return e.path == entry.path; };
        if (std::any_of(all.entries.begin(), all.entries.end(), same))
          refuse({"--set", 0}, entry.path, "a duplicate: the key is set twice", "each key once");
        if (entry.path == "include" || entry.path == "resolved")
          refuse({"--set", 0}, entry.path, describe(entry.value), "this key only inside a case file");
        entry.layer = layer_ + 1;
        all.entries.push_back(std::move(entry));
      }
      all.tables.merge(one.tables);
      all.bodies = std::max(all.bodies, one.bodies);
    }
    ++layer_;
    merge(std::move(all));
  }

  Document take(std::string name) {
    document_.name = std::move(name);
    return std::move(document_);
  }

 private:
  void includes(const toml::table& root, const std::string& name, const fs::path& folder) {
    const toml::node* node = root.get("include");
    if (!node) return;
    const Place place{name, static_cast<int>(node->source().begin.line)};
    const auto one = [&](const toml::node& item) {
      const auto* path = item.as_string();
      if (!path || path->get().empty())
        refuse(place, "include", describe(convert(item)), "a path or an array of paths");
      file((folder / path->get()).lexically_normal(), place);
    };
    if (const auto* list = node->as_array())
      for (const toml::node& item : *list) one(item);
    else
      one(*node);
  }

  void merge(Flat flat) {
    if (flat.bodies >= 0) {  // a list of bodies replaces the one of the base as a whole
      std::erase_if(document_.entries, [](const auto& e) { return e.first.starts_with("bodies."); });
      std::erase_if(document_.tables, [](const auto& t) { return t.first.starts_with("bodies."); });
      document_.bodies = flat.bodies;
    }
    for (Entry& entry : flat.entries) {
      const std::string path = entry.path;
      document_.entries.insert_or_assign(path, std::move(entry));
    }
    for (auto& [path, place] : flat.tables) document_.tables.insert_or_assign(path, place);
  }

  static toml::table parse_override(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(fmt::format("--set: '{}': found no key and value; allowed section.key=value", text));
    const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
    if (text.find('\n') != std::string::npos)
      throw UsageError(fmt::format("--set: {}: found a line break; allowed section.key=value", key));
    try {
      return toml::parse(text);
    } catch (const toml::parse_error& e) {
      const bool word = !value.empty() && (std::isalpha(static_cast<unsigned char>(value[0])) ||
                                           value[0] == '.' || value[0] == '/');
      if (word && value.find_first_of("\"'\\") == std::string::npos) {
        try {
          return toml::parse(key + "=\"" + value + "\"");
        } catch (const toml::parse_error&) {  // the key is what is wrong: report the first error
        }
      }
      throw UsageError(fmt::format("--set: {}: TOML syntax: {}", key, e.description()));
    }
  }

  IsTableValue is_table_value_;
  int layer_ = 0;
  std::vector<fs::path> open_;
  Document document_;
};

}  // namespace

void refuse(const Place& place, std::string_view key, std::string_view found, std::string_view allowed,
            std::string_view nearest) {
  std::string message = fmt::format("{}: {}: found {}; allowed {}", at(place), key, found, allowed);
  if (!nearest.empty()) message += fmt::format("; did you mean '{}'?", nearest);
  throw UsageError(message);
}

const Entry* Document::find(std::string_view path) const {
  const auto it = entries.find(std::string(path));
  return it == entries.end() ? nullptr : &it->second;
}

Place Document::place(std::string_view path) const {
  if (const Entry* entry = find(path)) return entry->place;
  for (std::string_view section = path; section.find('.') != std::string_view::npos;) {
    section = section.substr(0, section.rfind('.'));
    if (const auto it = tables.find(std::string(section)); it != tables.end()) return it->second;
  }
  return {name, 1};
}

int Document::layer(std::string_view path) const {
  const Entry* entry = find(path);
  return entry ? entry->layer : 0;
}

bool Document::may_be_idle(std::string_view path, const std::vector<std::string>& decided_by) const {
  const int own = layer(path);
  return resolved.contains(own) || std::any_of(decided_by.begin(), decided_by.end(),
                                               [&](const std::string& key) { return layer(key) > own; });
}

Document load_document(const fs::path& file, const std::vector<std::string>& overrides,
                       IsTableValue is_table_value) {
  Loader loader(is_table_value);
  loader.file(file, {});
  loader.overrides(overrides);
  return loader.take(file.string());
}

Document parse_document(const std::string& text, const std::string& name,
                        const std::vector<std::string>& overrides, IsTableValue is_table_value) {
  Loader loader(is_table_value);
  loader.parse(text, name, fs::path(name).parent_path());
  loader.overrides(overrides);
  return loader.take(name);
}

}  // namespace meltray::scene
