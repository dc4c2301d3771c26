// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace meltray::scene {

struct Value;
using Array = std::vector<Value>;
struct Table {
  std::vector<std::string> names;
  std::vector<Value> values;
};
/// A TOML type that no key takes (dates and times), as the words that describe it.
struct OtherType {
  std::string what;
};

/// A value of a case file, apart from the library that parsed it.
struct Value {
  std::variant<bool, std::int64_t, double, std::string, Array, Table, OtherType> data;

  bool is_number() const;
  /// An integer counts as a number.
  double number() const;
  const std::string* text() const { return std::get_if<std::string>(&data); }
  const Array* array() const { return std::get_if<Array>(&data); }
  const Table* table() const { return std::get_if<Table>(&data); }
};

Value array_of(const std::vector<double>& numbers);

/// For messages: the value with its type where the type is the point, e.g. `"fast" (text)`.
std::string describe(const Value& value);
/// As TOML; numbers are written so that reading them gives the same bits.
std::string to_toml(const Value& value);

}  // namespace meltray::scene
