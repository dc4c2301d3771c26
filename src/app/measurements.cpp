// SPDX-License-Identifier: MIT
#include "app/measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"

namespace meltray::app {
namespace {

constexpr std::array<std::string_view, 8> kColumns = {
    "material",    "f_hz",  "amplitude_ratio_mm_per_kw", "mean_depth_mm", "phase_lag_deg", "definition",
    "uncertainty", "source"};

std::string trimmed(std::string_view s) {
  const auto begin = s.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return "";
  return std::string(s.substr(begin, s.find_last_not_of(" \t\r") - begin + 1));
}

struct Place {
  std::string file;
  std::size_t line;
  [[noreturn]] void fail(std::string_view what) const {
    throw UsageError(fmt::format("{}:{}: {}", file, line, what));
  }
};

/// Fields of a line; double quotes may hold commas, two of them stand for one.
std::vector<std::string> fields(std::string_view line, const Place& place) {
  std::vector<std::string> out;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      field += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      out.push_back(trimmed(field));
      field.clear();
    } else {
      field += c;
    }
  }
  if (quoted) place.fail("a quotation mark is not closed");
  out.push_back(trimmed(field));
  return out;
}

std::optional<double> number(const std::string& text, std::string_view column, const Place& place) {
  if (text.empty()) return std::nullopt;
  double v = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(v))
    place.fail(fmt::format("{}: found '{}'; allowed a number or nothing", column, text));
  return v;
}

std::vector<std::string> read_header(const std::string& line, const Place& place) {
  auto names = fields(line, place);
  for (const auto& name : names) {
    if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end())
      place.fail(fmt::format("unknown column '{}'; allowed {}", name, fmt::join(kColumns, ", ")));
    if (std::count(names.begin(), names.end(), name) > 1)
      place.fail(fmt::format("column '{}' stands twice", name));
  }
  for (const char* needed : {"material", "f_hz"})
    if (std::find(names.begin(), names.end(), needed) == names.end())
      place.fail(fmt::format("column '{}' is missing; columns are {}", needed, fmt::join(kColumns, ", ")));
  return names;
}

Measurement read_row(const std::vector<std::string>& names, const std::vector<std::string>& row,
                     const Place& place) {
  if (row.size() != names.size())
    place.fail(fmt::format("found {} fields; the header has {}", row.size(), names.size()));
  const auto text = [&](std::string_view name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? std::string() : row[static_cast<std::size_t>(at - names.begin())];
  };
  const auto value = [&](std::string_view name) { return number(text(name), name, place); };
  const auto not_negative = [&](std::string_view name) {
    const auto v = value(name);
    if (v && *v < 0) place.fail(fmt::format("{}: found {}; allowed 0 or more", name, *v));
    return v;
  };
  Measurement m;
  m.material = text("material");
  if (m.material.empty()) place.fail("material: found nothing; a name is needed");
  const auto f = value("f_hz");
  if (!f || *f <= 0) place.fail(fmt::format("f_hz: found '{}'; allowed a number above 0", text("f_hz")));
  m.frequency = *f;
  m.ratio_mm_per_kw = not_negative("amplitude_ratio_mm_per_kw");
  m.mean_depth_mm = not_negative("mean_depth_mm");
  m.phase_lag_deg = value("phase_lag_deg");
  m.definition = text("definition");
  m.uncertainty = not_negative("uncertainty");
  m.source = text("source");
  return m;
}

}  // namespace

std::vector<Measurement> read_measurements(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw UsageError(fmt::format("{}: no such file", file.string()));
  const std::string all = observe::read_text(file);
  std::vector<Measurement> out;
  std::vector<std::string> names;
  Place place{file.string(), 0};
  std::size_t begin = all.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // byte-order mark of spreadsheet programs
  while (begin < all.size()) {
    const auto end = std::min(all.find('\n', begin), all.size());
    const std::string line = trimmed(std::string_view(all).substr(begin, end - begin));
    begin = end + 1;
    ++place.line;
    if (line.empty() || line[0] == '#') continue;
    if (names.empty())
      names = read_header(line, place);
    else
      out.push_back(read_row(names, fields(line, place), place));
  }
  if (names.empty())
    throw UsageError(
        fmt::format("{}:1: no header; columns are {}", file.string(), fmt::join(kColumns, ", ")));
  if (out.empty())
    throw UsageError(fmt::format("{}:{}: no rows behind the header", file.string(), place.line));
  return out;
}

}  // namespace meltray::app
