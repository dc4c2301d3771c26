// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "app/validate/cases.hpp"
#include "app/validate/sampling.hpp"
#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {
namespace {

constexpr double kTravel = 0.6e-3;          ///< of the beam over the plate, five to seven spots [m]
constexpr double kJudged = 2.0 / 3;         ///< share of the travel after which the depth is averaged
constexpr double kTi64Absorptivity = 0.35;  ///< its index is not known; common to public codes, not fitted

/// Beads of one metal at one speed.
struct Bead {
  std::string metal;
  double spot, speed, power, depth;  ///< [m], [m/s], [W], [m]
  std::string series() const { return fmt::format("{} {} m/s", metal, speed); }
  std::string name() const { return fmt::format("{}-{}m-s-{}w", metal, speed, power); }
};

std::vector<Bead> beads(const Table& table) {
  std::vector<Bead> out;
  for (std::size_t r = 0; r < table.rows(); ++r)
    out.push_back({table.text(r, "material"), 1e-6 * table.number(r, "spot_um"), table.number(r, "speed_m_s"),
                   table.number(r, "power_w"), 1e-6 * table.number(r, "depth_um")});
  return out;
}

scene::Overrides keys(const Bead& b) {
  scene::Overrides set{"material.name=" + b.metal, fmt::format("laser.focal_diameter_m={:.6g}", b.spot),
                       fmt::format("laser.feed_m_per_min={:.6g}", 60 * b.speed),
                       fmt::format("laser.power_w={:.6g}", b.power)};
  if (b.metal == "ti64") set.push_back(fmt::format("laser.absorptivity={}", kTi64Absorptivity));
  return set;
}

/// Mean depth of the void over the last third of the travel [m].
double mean_depth(const std::filesystem::path& folder, double end) {
  const auto history = observe::read_history(folder / "history.csv");
  const auto &time = history.at("time_s"), &depth = history.at("capillary_depth_m");
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] >= kJudged * end) {
      sum += depth[i];
      ++count;
    }
  return sum / count;
}

/// Depth over power of one series, measured and simulated.
struct Series {
  std::map<double, double> measured, simulated;
};

void judge_series(const std::string& name, const Series& s, const std::string& source, Rows& rows) {
  if (s.simulated.size() < 2) return;
  const Measured how{"", 0, source};
  rows.push_back(relative_row(name + ": slope [mm/kW]", 1e6 * slope_of_line(s.simulated),
                              1e6 * slope_of_line(s.measured), 0.3, how));
  double fall = 0, before = 0;
  for (const auto& [power, depth] : s.simulated) {
    fall = std::max(fall, before - depth);
    before = depth;
  }
  rows.push_back(limit_row(name + ": largest fall of the depth with power [m]", fall, 0, how));
}

/// Two powers on a coarse plate for a short time: the stronger beam drills deeper.
Rows twin(const Setting& setting, const Table& table) {
  const auto all = beads(table);
  const Watch watch;
  std::vector<double> depth;
  for (const Bead* b : {&all[0], &all[3]}) {
    auto set = keys(*b);
    set.insert(set.end(), {"domain.spacing_m=2.5e-5", "time.end_s=1e-4"});
    const auto simulation = start(setting, set);
    advance(*simulation, simulation->scene().time.end);
    depth.push_back(observe::measure(*simulation, {}).capillary_depth);
  }
  Row deeper = limit_row("void after 0.1 ms, weak over strong beam", depth[0] / depth[1], 1,
                         {"dx 25 um", watch.seconds(), table.source()});
  return {deeper};
}

}  // namespace

std::vector<ListedRun> keyhole_depth_xray_welds(const Setting& setting) {
  if (setting.small) return {};
  std::vector<ListedRun> welds;
  for (const Bead& b : beads(Table(setting.folder / "reference.csv")))
    welds.push_back({setting.folder / "case.toml", setting.out / b.name(), keys(b), kTravel / b.speed});
  return welds;
}

Rows keyhole_depth_xray(const Setting& setting) {
  const Table table(setting.folder / "reference.csv");
  if (setting.small) return twin(setting, table);
  const auto list = keyhole_depth_xray_welds(setting);
  const auto measured = beads(table);
  Rows rows;
  std::map<std::string, Series> series;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto summary = observe::recorded_summary(list[k].folder);
    if (!reached(list[k], summary)) continue;
    const Bead& b = measured[k];
    const double depth = mean_depth(list[k].folder, list[k].until);
    rows.push_back(relative_row(
        fmt::format("{}, {} W: depth [m]", b.series(), b.power), depth, b.depth, 0.25,
        {resolution_text(spacing_of(list[k].folder)), summary.value("wall_seconds", 0.0), table.source()}));
    series[b.series()].measured[b.power] = b.depth;
    series[b.series()].simulated[b.power] = depth;
  }
  for (const auto& [name, s] : series) judge_series(name, s, table.source(), rows);
  return rows;
}

}  // namespace meltray::app
