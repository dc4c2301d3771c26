// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "meltray/scene/presets.hpp"
#include "scene/case_document.hpp"
#include "scene/keys.hpp"

/// Binding of a key to a member of the scene `s`, with `i` for the face or body.
#define MELTRAY_AT(member)                       \
  [](auto& s, [[maybe_unused]] int i) -> auto& { \
    return s.member;                             \
  }

/// Builders of keys, one per kind of value.
namespace meltray::scene {

template <class At>
Key boolean(std::string path, At at, std::string sentence) {
  Key k{.path = std::move(path), .kind = Kind::boolean, .unit = "", .sentence = std::move(sentence)};
  k.get = [at](const Scene& s, int i) { return Value{at(s, i)}; };
  k.set = [at](Scene& s, int i, const Value& v) { at(s, i) = std::get<bool>(v.data); };
  return k;
}

template <class At>
Key integer(std::string path, Range range, At at, std::string sentence) {
  Key k{.path = std::move(path),
        .kind = Kind::integer,
        .unit = "",
        .sentence = std::move(sentence),
        .range = range};
  k.get = [at](const Scene& s, int i) { return Value{static_cast<std::int64_t>(at(s, i))}; };
  k.set = [at](Scene& s, int i, const Value& v) {
    at(s, i) = static_cast<int>(std::get<std::int64_t>(v.data));
  };
  return k;
}

template <class At>
Key number(std::string path, std::string unit, Range range, At at, std::string sentence) {
  Key k{.path = std::move(path),
        .kind = Kind::number,
        .unit = std::move(unit),
        .sentence = std::move(sentence),
        .range = range};
  k.get = [at](const Scene& s, int i) { return Value{at(s, i)}; };
  k.set = [at](Scene& s, int i, const Value& v) { at(s, i) = v.number(); };
  return k;
}

/// Number that the scene keeps in SI, the case file in a unit of which `per_si` make one of SI.
template <class At>
Key number_in(double per_si, std::string path, std::string unit, Range range, At at, std::string sentence) {
  Key k = number(std::move(path), std::move(unit), range, at, std::move(sentence));
  k.get = [at, per_si](const Scene& s, int i) {
    const double si = at(s, i);
    double x = si * per_si;  // rounding may miss the number that gives `si` back by a bit or two
    for (double low = x, high = x; x / per_si != si && high - low < 1e-14 * std::abs(si * per_si);) {
      low = std::nextafter(low, -INFINITY);
      high = std::nextafter(high, INFINITY);
      x = low / per_si == si ? low : high;
    }
    return Value{x};
  };
  k.set = [at, per_si](Scene& s, int i, const Value& v) { at(s, i) = v.number() / per_si; };
  return k;
}

/// Number that also takes a word for "without a limit", which the scene keeps as 1e300.
template <class At>
Key number_or_unlimited(std::string word, std::string path, std::string unit, Range range, At at,
                        std::string sentence) {
  constexpr double unlimited = 1e300;
  Key k = number(std::move(path), std::move(unit), range, at, std::move(sentence));
  k.words = {word};
  k.get = [at, word](const Scene& s, int i) { return at(s, i) >= unlimited ? Value{word} : Value{at(s, i)}; };
  k.set = [at](Scene& s, int i, const Value& v) { at(s, i) = v.is_number() ? v.number() : unlimited; };
  return k;
}

template <class Enum>
using Words = std::vector<std::pair<std::string, Enum>>;

template <class Enum, class At>
Key word(std::string path, Words<Enum> words, At at, std::string sentence) {
  Key k{.path = std::move(path), .kind = Kind::word, .unit = "", .sentence = std::move(sentence)};
  for (const auto& [name, value] : words) k.words.push_back(name);
  k.get = [at, words](const Scene& s, int i) {
    const auto is = [&](const auto& w) { return w.second == at(s, i); };
    const auto it = std::find_if(words.begin(), words.end(), is);
    if (it == words.end())
      throw std::logic_error("a scene made in code has a choice that case files do not offer");
    return Value{it->first};
  };
  k.set = [at, words](Scene& s, int i, const Value& v) {
    const auto is = [&](const auto& w) { return w.first == *v.text(); };
    at(s, i) = std::find_if(words.begin(), words.end(), is)->second;
  };
  return k;
}

/// Vector with one entry per dimension: x, y, z, or x and z of a 2-D scene (the third component is then 0).
template <class At>
Key vector(std::string path, std::string unit, Range range, At at, std::string sentence) {
  Key k{.path = std::move(path),
        .kind = Kind::vector,
        .unit = std::move(unit),
        .sentence = std::move(sentence),
        .range = range};
  k.get = [at](const Scene& s, int i) {
    const Vec3& v = at(s, i);
    return s.domain.dimension == 2 ? array_of({v[0], v[1]}) : array_of({v[0], v[1], v[2]});
  };
  k.set = [at](Scene& s, int i, const Value& value) {
    const Array& a = *value.array();
    at(s, i) = Vec3(a[0].number(), a[1].number(), a.size() == 3 ? a[2].number() : 0.0);
  };
  return k;
}

/// The need for a term to be on.
template <class Member>
Need term(const char* name, Member member) {
  const std::string key = std::string("terms.") + name;
  return {key + " = true", {key}, [member](const Scene& s, int) { return s.terms.*member; }};
}

/// The need for a solver of the flow.
Need solved_by(FlowSolver solver);

/// The need for elastic solid.
Need elastic();

/// Default from the row of Table 1 that the case names, where it names one and has a flow: `member` is the
/// row's choice, `at` the place in the scene.
template <class Member, class At>
Key of_row(Key key, const char* else_text, Member member, At at) {
  return key.otherwise(std::string("of the model where that is given, else ") + else_text,
                       [member, at](Scene& s, int i, const Document& d) {
                         if (d.given("model") && s.terms.pressure) at(s, i) = preset_of(s.model).*member;
                       });
}

inline void append(std::vector<Key>& keys, std::vector<Key> more) {
  keys.insert(keys.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace meltray::scene
