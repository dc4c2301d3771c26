// SPDX-License-Identifier: MIT
#include "app/validate/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/json_number.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/version.hpp"

namespace meltray::app {
namespace {

constexpr int kSchemaVersion = 1;
constexpr const char* kLine = "{:<22} {:<46} {:<13} {:>11} {:>11} {:>9} {:>9} {:>9} {:>6} {:>7}  {}\n";

std::string text(const std::optional<double>& number, const char* form) {
  return number ? fmt::format(fmt::runtime(form), *number) : "-";
}

std::string verdict(const Row& r) {
  if (!r.judged) return "report";
  if (!r.passed()) return r.known_failure.empty() ? "FAIL" : "FAIL (known)";
  return r.goal && r.error > *r.goal ? "pass, goal missed" : "pass";
}

}  // namespace

void print_header() {
  fmt::print(fmt::runtime(kLine), "id", "quantity", "resolution", "value", "reference", "error", "tolerance",
             "goal", "order", "seconds", "result");
}

void print_rows(const Rows& rows) {
  for (const Row& r : rows)
    fmt::print(fmt::runtime(kLine), r.id, r.quantity, r.resolution.empty() ? "-" : r.resolution,
               fmt::format("{:.5g}", r.value), fmt::format("{:.5g}", r.reference),
               fmt::format("{:.2e}", r.error), r.judged ? fmt::format("{:.2e}", r.tolerance) : "-",
               text(r.goal, "{:.2e}"), text(r.order, "{:.2f}"), fmt::format("{:.1f}", r.seconds), verdict(r));
  std::fflush(stdout);
}

void write_json(const std::filesystem::path& file, const Rows& rows) {
  auto list = nlohmann::json::array();
  for (const Row& r : rows)
    list.push_back({{"id", r.id},
                    {"quantity", r.quantity},
                    {"resolution", r.resolution},
                    {"value", json_number(r.value)},
                    {"reference", json_number(r.reference)},
                    {"error", json_number(r.error)},
                    {"tolerance", r.judged ? json_number(r.tolerance) : nullptr},
                    {"goal", json_number(r.goal)},
                    {"passed", r.passed()},
                    {"judged", r.judged},
                    {"known_failure", r.known_failure},
                    {"order", json_number(r.order)},
                    {"seconds", r.seconds},
                    {"source", r.source}});
  const bool passed = std::all_of(rows.begin(), rows.end(), [](const Row& r) { return r.passed(); });
  const nlohmann::json document = {{"schema_version", kSchemaVersion},
                                   {"version", observe::version()},
                                   {"passed", passed},
                                   {"rows", list}};
  observe::write_file(file, document.dump(2) + '\n');
}

}  // namespace meltray::app
