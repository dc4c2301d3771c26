// SPDX-License-Identifier: MIT
#include "scene/property_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meltray/core/nearest.hpp"

namespace meltray::scene {

namespace {

/// Entries of the table besides `form`; the last two have defaults.
struct Form {
  Property::Form form;
  std::string name;
  std::vector<std::pair<std::string, double Property::*>> entries;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> all = {{Property::Form::linear,
                                         "linear",
                                         {{"value", &Property::a},
                                          {"slope", &Property::b},
                                          {"reference_k", &Property::t_ref},
                                          {"min_k", &Property::t_min},
                                          {"max_k", &Property::t_max}}},
                                        {Property::Form::andrade,
                                         "andrade",
                                         {{"a", &Property::a},
                                          {"b_k", &Property::b},
                                          {"min_k", &Property::t_min},
                                          {"max_k", &Property::t_max}}}};
  return all;
}

bool optional(const std::string& entry) {
  return entry == "min_k" || entry == "max_k";
}

const Form& form_of(const Table& table, const Value& whole, const std::string& allowed) {
  for (std::size_t k = 0; k < table.names.size(); ++k)
    if (table.names[k] == "form" && table.values[k].text())
      for (const Form& form : forms())
        if (form.name == *table.values[k].text()) return form;
  throw Refusal{describe(whole), allowed, {}};
}

/// Formulas are monotonous, so that both ends of their range of temperatures are within bounds or one is not;
/// without ends of its own a formula has to hold where metals are simulated.
void check_ends(const Property& p, const Range& range) {
  constexpr double kCold = 1, kHot = 1e4;  // [K]
  for (const double t : {std::max(p.t_min, kCold), std::min(p.t_max, kHot)})
    if (!range.contains(p(t)))
      throw Refusal{fmt::format("{:.6g} at {:.6g} K", p(t), t),
                    fmt::format("values {} from min_k to max_k ({:g} and {:g} K where not given)",
                                range.text(), kCold, kHot),
                    {}};
}

Property from_table(const Value& whole, const Range& range, const std::string& allowed) {
  const Table& table = *whole.table();
  const Form& form = form_of(table, whole, allowed);
  Property p;
  p.form = form.form;
  std::vector<std::string> known = {"form"}, missing;
  for (const auto& [name, member] : form.entries) {
    known.push_back(name);
    const auto it = std::find(table.names.begin(), table.names.end(), name);
    if (it == table.names.end()) {
      if (!optional(name)) missing.push_back(name);
      continue;
    }
    const Value& value = table.values[static_cast<std::size_t>(it - table.names.begin())];
    if (!value.is_number() || !std::isfinite(value.number()))
      throw Refusal{fmt::format("{} = {}", name, describe(value)), "a finite number; " + allowed, {}};
    p.*member = value.number();
  }
  for (const std::string& name : table.names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Refusal{fmt::format("unknown entry '{}'", name), allowed, nearest_name(name, known)};
  if (!missing.empty()) throw Refusal{fmt::format("a table without '{}'", missing.front()), allowed, {}};
  if (!(p.t_min < p.t_max))
    throw Refusal{fmt::format("min_k = {}, max_k = {}", p.t_min, p.t_max), "min_k < max_k", {}};
  check_ends(p, range);
  return p;
}

}  // namespace

std::string property_forms(const Range& range, const std::string& unit) {
  return fmt::format(
      "a number {} [{}], {{ form = \"linear\", value, slope, reference_k, min_k, max_k }} or "
      "{{ form = \"andrade\", a, b_k, min_k, max_k }}",
      range.text(), unit);
}

Property read_property(const Value& value, const Range& range, const Range& of_formula,
                       const std::string& allowed) {
  if (value.table()) return from_table(value, of_formula, allowed);
  if (!value.is_number()) throw Refusal{describe(value), allowed, {}};
  if (!std::isfinite(value.number())) throw Refusal{describe(value), "finite numbers: " + allowed, {}};
  if (!range.contains(value.number())) throw Refusal{describe(value), allowed, {}};
  return constant(value.number());
}

Value write_property(const Property& property) {
  for (const Form& form : forms()) {
    if (form.form != property.form) continue;
    Table table{{"form"}, {Value{form.name}}};
    for (const auto& [name, member] : form.entries) {
      table.names.push_back(name);
      table.values.push_back({property.*member});
    }
    return {std::move(table)};
  }
  return {property.a};
}

}  // namespace meltray::scene
