// SPDX-License-Identifier: MIT
// The paper's matrix of welds, its table of steps and times, and its figures 3 to 5.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/listed_run.hpp"
#include "app/repository.hpp"
#include "app/response.hpp"
#include "app/script.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/history.hpp"
#include "meltray/observe/run_folder.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/presets.hpp"

namespace meltray::app {
namespace fs = std::filesystem;
namespace {

/// Largest displacement of the solid's particles by a seed, in spacings: enough to tell welds apart.
constexpr double kSeedJitter = 0.05;
/// Of Young's modulus in the row with elastic solid: sound in it is then as slow as in the melt.
constexpr double kModulusScale = 1e-4;
constexpr const char* kIsph = "isph";

/// Steps, speed of sound and artificial viscosity of a metal's weakly compressible cases, for another row or
/// frequency.
std::vector<std::string> of_weakly_compressible(const fs::path& cases, const std::string& metal,
                                                const std::string& model) {
  const scene::Scene like = scene::read_case(cases / fmt::format("weld_{}_100hz_wcsph_reduced.toml", metal));
  std::vector<std::string> set = {"time.method=multirate",
                                  fmt::format("time.fixed_step_s={}", like.time.integrator.fixed_step),
                                  fmt::format("time.cfl_acoustic={}", like.time.cfl_acoustic),
                                  fmt::format("time.cfl_advective={}", like.time.cfl_advective),
                                  fmt::format("time.cfl_force={}", like.time.cfl_force),
                                  fmt::format("time.cfl_capillary={}", like.time.cfl_capillary),
                                  fmt::format("flow.sound_speed_m_s={}", like.flow.sound_speed)};
  if (scene::preset_of(model).artificial_viscosity)
    set.push_back(fmt::format("flow.artificial_viscosity={}", like.flow.artificial_viscosity));
  return set;
}

/// One weld of the matrix.
struct Weld : ListedRun {
  std::string metal, model;
  int frequency = 0, seed = 0;  ///< [Hz]; seed 0: undisturbed lattice
};

std::vector<Weld> matrix(const PaperArguments& a) {
  const fs::path cases = repository_folder("cases", "MELTRAY_CASES");
  const int first_seed = a.seeds == 1 ? 0 : 1, last_seed = a.seeds == 1 ? 0 : a.seeds;
  std::vector<Weld> welds;
  for (const auto& metal : a.metals)
    for (const int frequency : a.frequencies)
      for (const auto& model : a.models)
        for (int seed = first_seed; seed <= last_seed; ++seed) {
          Weld w{{cases / fmt::format("weld_{}_{}hz.toml", metal, frequency), {}, {}, 0},
                 metal,
                 model,
                 frequency,
                 seed};
          w.folder = a.out / fmt::format("{}-{}hz-{}-seed{}", metal, frequency, model, seed);
          if (!fs::exists(w.case_file))
            throw UsageError(fmt::format("study paper: {} at {} Hz: there is no {}", metal, frequency,
                                         w.case_file.string()));
          w.set.push_back("model=" + model);
          if (model != kIsph) {
            const auto more = of_weakly_compressible(cases, metal, model);
            w.set.insert(w.set.end(), more.begin(), more.end());
          }
          if (model == "wcsph")  // steps of the full modulus would take weeks
            w.set.push_back(fmt::format("flow.elastic_modulus_scale={}", kModulusScale));
          if (seed > 0)
            w.set.insert(w.set.end(),
                         {"domain.arrangement=jittered", fmt::format("domain.jitter={}", kSeedJitter),
                          fmt::format("domain.seed={}", seed)});
          for (const std::string& setting : a.set) {
            const std::string key = setting.substr(0, setting.find('=') + 1);
            std::erase_if(w.set, [&](const std::string& s) { return s.starts_with(key); });
            w.set.push_back(setting);
          }
          w.until = a.until.value_or(scene::read_case(w.case_file, w.set).time.end);
          welds.push_back(std::move(w));
        }
  return welds;
}

/// Mean length of a step [s].
double mean_step(const nlohmann::json& summary) {
  return summary.value("time_s", 0.0) / std::max(1, summary.value("steps", 0));
}

/// Two-sided 95 % quantile of Student's distribution with n - 1 degrees of freedom over sqrt(n).
double interval95(double deviation, int n) {
  static constexpr double kStudent[] = {12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26};
  if (n < 2) return std::nan("");
  const int degrees = n - 1;
  return (degrees <= 9 ? kStudent[degrees - 1] : 2.0) * deviation / std::sqrt(n);
}

/// Sums over the seeds: runs, mean step [s], wall seconds per simulated millisecond.
struct Cost {
  double runs = 0, step = 0, wall = 0;
};

std::string row_of(const Weld& w, const nlohmann::json& s) {
  std::string row =
      fmt::format("{},{},{},{},{},{:.9g},{},{:.9g},{:.6g},{:.6g}", w.metal, w.frequency, w.model, w.seed,
                  s.value("outcome", "?"), s.value("time_s", 0.0), s.value("steps", 0), mean_step(s),
                  s.value("wall_seconds", 0.0), s.value("wall_seconds_per_simulated_ms", 0.0));
  const History history = observe::read_history(w.folder / "history.csv");
  for (const char* depth : {"capillary_depth_m", "axis_depth_m"}) {
    try {
      const DepthResponse r = depth_response(history, depth, w.frequency);
      row += fmt::format(",{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}", r.periods, r.mean, r.half_range_ratio,
                         interval95(r.half_range_spread, r.periods), r.harmonic_ratio, r.lag);
    } catch (const UsageError&) {
      row += ",0,,,,,";  // fewer than two periods: no amplitude
    }
  }
  return row + '\n';
}

/// Mean steps and wall times of the methods, with the ratios that the paper states.
std::string ratios(const std::map<std::pair<std::string, int>, std::map<std::string, Cost>>& costs) {
  std::string text;
  for (const auto& [weld, models] : costs) {
    const auto isph = models.find(kIsph);
    for (const auto& [model, c] : models) {
      text += fmt::format("{:<10} {:>4} Hz  {:<24} mean step {:.3g} s, {:.3g} wall s per ms", weld.first,
                          weld.second, model, c.step / c.runs, c.wall / c.runs);
      if (model != kIsph && isph != models.end())
        text += fmt::format("; step ISPH : this {:.2f}, wall this : ISPH {:.2f}",
                            isph->second.step / isph->second.runs / (c.step / c.runs),
                            c.wall / c.runs / (isph->second.wall / isph->second.runs));
      text += '\n';
    }
  }
  return text;
}

}  // namespace

int study_paper(const PaperArguments& a) {
  if (!a.set.empty() && a.out == PaperArguments{}.out)
    throw UsageError(
        fmt::format("study paper: --set: found the folder of the runs without, {}; allowed "
                    "with --out and another folder",
                    a.out.string()));
  const auto welds = matrix(a);
  if (a.list) {
    for (const Weld& w : welds)
      if (!reached(w, observe::recorded_summary(w.folder))) fmt::print("{}\n", command_of(w));
    return kExitOk;
  }
  fs::create_directories(a.out);
  std::string table =
      "metal,f_hz,model,seed,outcome,time_s,steps,mean_step_s,wall_s,wall_s_per_ms,"
      "periods,mean_mm,half_range_mm_per_kw,half_range_95,harmonic_mm_per_kw,lag_deg,"
      "axis_periods,axis_mean_mm,axis_half_range_mm_per_kw,axis_half_range_95,axis_harmonic_mm_per_kw,axis_"
      "lag_deg\n";
  std::map<std::pair<std::string, int>, std::map<std::string, Cost>> costs;
  for (const Weld& w : welds) {
    if (!reached(w, observe::recorded_summary(w.folder))) {
      fmt::print("{}\n", w.folder.string());
      std::fflush(stdout);
      const int code = carry_out(w, a.threads);
      if (code != kExitOk) return code;
    }
    const auto s = observe::recorded_summary(w.folder);
    if (s.empty()) continue;
    table += row_of(w, s);
    if (!reached(w, s)) continue;  // a failed run has no cost to compare
    Cost& c = costs[{w.metal, w.frequency}][w.model];
    c.runs += 1;
    c.step += mean_step(s);
    c.wall += s.value("wall_seconds_per_simulated_ms", 0.0);
  }
  observe::replace_file(a.out / "paper.csv", table);
  const std::string summary = ratios(costs);
  observe::replace_file(a.out / "ratios.txt", summary);
  fmt::print("{}", summary);
  return run_script("plot_paper.py", {a.out.string()});
}

}  // namespace meltray::app
