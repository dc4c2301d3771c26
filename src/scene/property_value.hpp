// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/keys.hpp"

/// A material property in a case file: a number, or a table
///   { form = "linear", value, slope, reference_k, min_k, max_k }   value + slope (T - reference_k)
///   { form = "andrade", a, b_k, min_k, max_k }                     10^(a + b_k/T)
/// that is held at its end values outside [min_k, max_k].
namespace meltray::scene {

std::string property_forms(const Range& range, const std::string& unit);
/// `range` is that of a constant, `of_formula` that of a formula's values. Throws Refusal, with `allowed` in
/// its message.
Property read_property(const Value& value, const Range& range, const Range& of_formula,
                       const std::string& allowed);
Value write_property(const Property& property);

}  // namespace meltray::scene
