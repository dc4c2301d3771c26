// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/response.hpp"
#include "app/validate/cases.hpp"
#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/run_folder.hpp"

namespace meltray::app {
namespace {

constexpr double kPulse = 10e-3;              ///< [s]
constexpr double kSpotRadius = 0.5 * 303e-6;  ///< [m]
constexpr double kFlat = 0.31,
                 kOnset = 0.4;      ///< absorbed without a capillary; intensity of its start [MW/cm^2]
constexpr double kSaturated = 0.8;  ///< intensities above it [MW/cm^2] are judged by the saturated share
/// A capillary shows in the absorbed power, as in the experiment: when its mean over so long [s] has risen by
/// this share over that of the flat plate.
constexpr double kMeanOver = 50e-6, kRise = 0.1;

struct Spot {
  double intensity, power, absorbed, keyhole;  ///< [MW/cm^2], [W], share, [s] (NaN: none)
};

std::vector<Spot> spots(const Table& table) {
  std::vector<Spot> out;
  for (std::size_t r = 0; r < table.rows(); ++r)
    out.push_back({table.number(r, "intensity_mw_cm2"), table.number(r, "energy_j") / kPulse,
                   table.number(r, "absorbed"), 1e-3 * table.number(r, "keyhole_ms")});
  return out;
}

std::string power_key(const Spot& s) {
  return fmt::format("laser.power_w={:.6g}", s.power);
}

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

/// First time at which the mean absorbed share of the last kMeanOver has risen by kRise [s]; NaN if it never
/// has.
double rise_of_absorption(const History& history) {
  const auto &time = history.at("time_s"), &absorbed = history.at("absorbed_power_w"),
             &power = history.at("laser_power_w");
  std::size_t first = 0;
  double light = 0, taken = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    light += power[i];
    taken += absorbed[i];
    for (; time[i] - time[first] > kMeanOver; ++first) {
      light -= power[first];
      taken -= absorbed[first];
    }
    if (time[i] >= kMeanOver && taken > (kFlat + kRise) * light) return time[i];
  }
  return kNever;
}

/// First time at which the void is as deep as the spot's radius [s]; NaN if it never is.
double deep_void(const History& history) {
  const auto& depth = history.at("capillary_depth_m");
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (depth[i] >= kSpotRadius) return history.at("time_s")[i];
  return kNever;
}

/// What one spot weld gave.
struct Weld {
  Spot spot;
  double absorbed, keyhole;
  double deep;  ///< time at which the void is as deep as the spot's radius [s]
};

void judge_spot(const Weld& w, const Measured& how, Rows& rows) {
  const bool flat = std::isnan(w.spot.keyhole), saturated = w.spot.intensity > kSaturated;
  Row share = absolute_row(fmt::format("{} MW/cm2: absorbed share", w.spot.intensity), w.absorbed,
                           w.spot.absorbed, flat ? 0.04 : 0.08, how);
  share.judged = flat || saturated;
  rows.push_back(share);
  if (flat && std::isnan(w.keyhole)) return;
  // Within a factor of two; a capillary on one side only is no number and fails.
  Row start = absolute_row(fmt::format("{} MW/cm2: start of the capillary [s]", w.spot.intensity), w.keyhole,
                           w.spot.keyhole, 1, how);
  start.error = std::abs(std::log2(w.keyhole / w.spot.keyhole));
  rows.push_back(start);
  Row deep =
      absolute_row(fmt::format("{} MW/cm2: void as deep as the radius of the spot [s]", w.spot.intensity),
                   w.deep, w.spot.keyhole, 0, how);
  deep.judged = false;
  rows.push_back(deep);
}

void judge_series(std::vector<Weld> welds, const std::string& source, Rows& rows) {
  std::sort(welds.begin(), welds.end(),
            [](const Weld& a, const Weld& b) { return a.spot.intensity < b.spot.intensity; });
  double fall = 0, below = 0, above = 0;
  for (std::size_t k = 0; k < welds.size(); ++k) {
    if (k > 0) fall = std::max(fall, welds[k - 1].absorbed - welds[k].absorbed);
    if (std::isnan(welds[k].keyhole)) below = welds[k].spot.intensity;
    if (!std::isnan(welds[k].keyhole) && above == 0) above = welds[k].spot.intensity;
  }
  if (welds.size() > 1)
    rows.push_back(limit_row("largest fall of the share with intensity", fall, 0, {"", 0, source}));
  if (below > 0 && above > below)
    rows.push_back(relative_row("intensity at which capillaries start [MW/cm2]", 0.5 * (below + above),
                                kOnset, 0.2, {"", 0, source}));
}

/// The flat plate before it melts, at twice the spacing.
Rows twin(const Setting& setting, const Table& table) {
  const Spot spot = spots(table).front();
  const Watch watch;
  const auto simulation = start(setting, {power_key(spot), "domain.spacing_m=3e-5", "time.end_s=2e-5"});
  advance(*simulation, simulation->scene().time.end);
  const auto laser = simulation->laser_budget();
  return {absolute_row("absorbed share before melting", laser.absorbed / laser.in, kFlat, 0.04,
                       {"dx 30 um", watch.seconds(), table.source()})};
}

}  // namespace

std::vector<ListedRun> absorptance_nist_316l_welds(const Setting& setting) {
  if (setting.small) return {};
  std::vector<ListedRun> welds;
  for (const Spot& s : spots(Table(setting.folder / "reference.csv")))
    welds.push_back({setting.folder / "case.toml",
                     setting.out / fmt::format("{}mw-cm2", s.intensity),
                     {power_key(s)},
                     kPulse});
  return welds;
}

Rows absorptance_nist_316l(const Setting& setting) {
  const Table table(setting.folder / "reference.csv");
  if (setting.small) return twin(setting, table);
  const auto list = absorptance_nist_316l_welds(setting);
  const auto measured = spots(table);
  Rows rows;
  std::vector<Weld> welds;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto summary = observe::recorded_summary(list[k].folder);
    if (!reached(list[k], summary)) continue;
    const auto& laser = summary.at("budgets").at("laser");
    const History history = observe::read_history(list[k].folder / "history.csv");
    welds.push_back({measured[k], laser.at("absorbed_j").get<double>() / laser.at("in_j").get<double>(),
                     rise_of_absorption(history), deep_void(history)});
    judge_spot(
        welds.back(),
        {resolution_text(spacing_of(list[k].folder)), summary.value("wall_seconds", 0.0), table.source()},
        rows);
  }
  judge_series(welds, table.source(), rows);
  return rows;
}

}  // namespace meltray::app
