// SPDX-License-Identifier: MIT
#include "scene/case_value.hpp"

#include <fmt/format.h>

namespace meltray::scene {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out + "\"";
}

std::string number_text(double x) {
  std::string out = fmt::format("{}", x);  // shortest text that reads back as x
  if (out.find_first_of(".en") == std::string::npos) out += ".0";
  return out;
}

struct ToToml {
  std::string operator()(bool b) const { return b ? "true" : "false"; }
  std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
  std::string operator()(double x) const { return number_text(x); }
  std::string operator()(const std::string& s) const { return quoted(s); }
  std::string operator()(const Array& a) const {
    std::string out = "[";
    for (std::size_t k = 0; k < a.size(); ++k) out += (k ? ", " : "") + to_toml(a[k]);
    return out + "]";
  }
  std::string operator()(const Table& t) const {
    std::string out = "{";
    for (std::size_t k = 0; k < t.names.size(); ++k)
      out += (k ? ", " : " ") + t.names[k] + " = " + to_toml(t.values[k]);
    return out + " }";
  }
  std::string operator()(const OtherType& o) const { return o.what; }
};

struct TypeName {
  std::string operator()(bool) const { return " (boolean)"; }
  std::string operator()(std::int64_t) const { return ""; }
  std::string operator()(double) const { return ""; }
  std::string operator()(const std::string&) const { return " (text)"; }
  std::string operator()(const Array&) const { return " (array)"; }
  std::string operator()(const Table&) const { return " (table)"; }
  std::string operator()(const OtherType&) const { return ""; }
};

}  // namespace

bool Value::is_number() const {
  return std::holds_alternative<double>(data) || std::holds_alternative<std::int64_t>(data);
}

double Value::number() const {
  if (const auto* i = std::get_if<std::int64_t>(&data)) return static_cast<double>(*i);
  return std::get<double>(data);
}

Value array_of(const std::vector<double>& numbers) {
  Array out;
  for (const double x : numbers) out.push_back({x});
  return {std::move(out)};
}

std::string to_toml(const Value& value) {
  return std::visit(ToToml{}, value.data);
}

std::string describe(const Value& value) {
  std::string text = to_toml(value);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text + std::visit(TypeName{}, value.data);
}

}  // namespace meltray::scene
