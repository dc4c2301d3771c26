// SPDX-License-Identifier: MIT
#include "app/validate/known_failures.hpp"

#include <fmt/format.h>

#include "app/toml_file.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app {
namespace {

std::string text_of(const toml::table& entry, const char* key, const std::string& file) {
  const auto value = entry[key].value<std::string>();
  if (!value || value->empty())
    throw UsageError(
        fmt::format("{}:{}: {}: found nothing; allowed a text", file, entry.source().begin.line, key));
  return *value;
}

double number_of(const toml::table& entry, const char* key, const std::string& file) {
  const auto value = entry[key].value<double>();
  if (!value || !(*value > 0))
    throw UsageError(fmt::format("{}:{}: {}: found {}; allowed a number > 0", file, entry.source().begin.line,
                                 key, value ? fmt::format("{}", *value) : "nothing"));
  return *value;
}

/// `pattern` may hold one "*", which stands for anything.
bool matches(const std::string& pattern, const std::string& text) {
  const auto star = pattern.find('*');
  if (star == std::string::npos) return pattern == text;
  return text.size() + 1 >= pattern.size() && text.starts_with(pattern.substr(0, star)) &&
         text.ends_with(pattern.substr(star + 1));
}

}  // namespace

KnownFailures::KnownFailures(const std::filesystem::path& file) {
  const toml::table table = read_toml(file);
  if (const auto* list = table["failure"].as_array())
    for (const auto& item : *list)
      if (const auto* entry = item.as_table())
        failures_.push_back({text_of(*entry, "id", file.string()), text_of(*entry, "quantity", file.string()),
                             text_of(*entry, "reason", file.string()),
                             number_of(*entry, "worst", file.string())});
}

void KnownFailures::mark(Rows& rows) const {
  for (Row& row : rows) {
    if (row.passed()) continue;
    for (const Failure& f : failures_)
      if (f.id == row.id && matches(f.quantity, row.quantity) && row.error <= f.worst)
        row.known_failure = f.reason;
  }
}

}  // namespace meltray::app
