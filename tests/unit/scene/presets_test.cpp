// SPDX-License-Identifier: MIT
#include "meltray/scene/presets.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "meltray/scene/case_file.hpp"
#include "meltray/scene/expected_flow.hpp"
#include "meltray/scene/optics.hpp"

using namespace meltray::scene;
using Catch::Matchers::Contains;

namespace {

Scene weld(const Overrides& set, const char* name = "weld_iron_2kw.toml") {
  const auto root = std::filesystem::path(__FILE__).parent_path() / "../../..";
  return read_case(root / "cases" / name, set);
}

}  // namespace

TEST_CASE("model picks a row of Table 1") {
  const Scene isph = weld({});
  CHECK(isph.flow.solver == FlowSolver::isph);
  CHECK((isph.terms.interface_viscosity && isph.terms.buoyancy && !isph.terms.artificial_viscosity));
  CHECK(isph.flow.shifting == 4);
  CHECK(row_of_table(isph) == "isph");

  const Scene reduced = weld({"model=wcsph_reduced"});
  CHECK(reduced.flow.solver == FlowSolver::wcsph);
  CHECK((!reduced.terms.interface_viscosity && reduced.terms.buoyancy && reduced.terms.artificial_viscosity));
  CHECK(!reduced.flow.thermal_expansion);
  CHECK(reduced.flow.shifting == 0);
  CHECK(row_of_table(reduced) == "wcsph_reduced");

  const Scene interface = weld({"model=wcsph_reduced_interface"});
  CHECK(interface.flow.shifting == 4);
  CHECK((interface.terms.interface_viscosity && !interface.terms.artificial_viscosity));
  CHECK(interface.flow.reference_speed == isph.flow.reference_speed);
  CHECK(row_of_table(interface) == "wcsph_reduced_interface");
}

TEST_CASE("each key of a row can be overridden, and the difference is told") {
  const Scene s = weld({"model=wcsph_reduced", "terms.buoyancy=false"});
  CHECK(!s.terms.buoyancy);
  CHECK_THAT(row_of_table(s),
             Contains("wcsph_reduced") && Contains("terms.buoyancy = false instead of true"));
}

TEST_CASE("the first row has expansion and an elastic solid, which can be fixed") {
  const Scene full = weld({"model=wcsph"});
  CHECK((full.flow.thermal_expansion && full.terms.artificial_viscosity && !full.terms.buoyancy));
  CHECK(full.flow.solid == SolidModel::elastic);
  CHECK(full.flow.elastic_modulus_scale == 1);
  CHECK(row_of_table(full) == "wcsph");
  const Scene s = weld({"model=wcsph", "flow.solid=fixed"});
  CHECK_THAT(row_of_table(s), Contains("flow.solid = fixed instead of elastic"));
}

TEST_CASE("contradictions of the flow are refused") {
  CHECK_THROWS_WITH(weld({"terms.artificial_viscosity=true"}), Contains("terms.artificial_viscosity"));
  CHECK_THROWS_WITH(weld({"flow.sound_speed_m_s=50"}), Contains("flow.solver = \"wcsph\""));
  CHECK_THROWS_WITH(weld({"model=wcsph_reduced", "flow.thermal_expansion=true"}), Contains("terms.buoyancy"));
  CHECK_THROWS_WITH(weld({"model=wcsph_reduced", "time.method=euler"}), Contains("euler"));
  CHECK_THROWS_WITH(weld({"model=wcsph_reduced", "flow.drift_time_s=1e-3"}),
                    Contains("flow.solver = \"isph\""));
  CHECK_THROWS_WITH(weld({"laser.optics=hot_melt"}), Contains("laser.optics"));
}

TEST_CASE("the default sound speed follows the recoil that a weld has to expect") {
  // 10 sqrt(0.54 p_sat(T_b + 300 K) / rho), Clausius-Clapeyron with L_v M / R = 40,904 K (Fe), 34,101 K (Al).
  const Scene iron = weld({"model=wcsph_reduced"});
  CHECK(
      iron.flow.sound_speed ==
      Approx(10 * std::sqrt(0.54 * 101325 * std::exp(40904 * (1 / 3134. - 1 / 3434.)) / 7035)).epsilon(1e-3));
  const Scene aluminium = weld({"model=wcsph_reduced"}, "weld_aluminium_100hz.toml");
  CHECK(
      aluminium.flow.sound_speed ==
      Approx(10 * std::sqrt(0.54 * 101325 * std::exp(34074 * (1 / 2792. - 1 / 3092.)) / 2377)).epsilon(1e-3));
}

TEST_CASE("the index of hot aluminium absorbs 14 %, that of the solid 5.4 %") {
  const Scene hot = weld({}, "weld_aluminium_100hz.toml");
  CHECK(meltray::laser::absorptance(laser_index(hot).liquid, 1) == Approx(0.138).margin(1e-3));
  CHECK(meltray::laser::absorptance(laser_index(hot).solid, 1) == Approx(0.054).margin(1e-3));
  const Scene cold = weld({"laser.optics=solid"}, "weld_aluminium_100hz.toml");
  CHECK(laser_index(cold).liquid == laser_index(cold).solid);
}
