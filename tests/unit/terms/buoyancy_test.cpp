// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "meltray/terms/surface_forces.hpp"
#include "unit/terms/stage_setup.hpp"

using namespace meltray;
using meltray::test::StageSetup;

TEST_CASE("buoyancy: Eq. (8), a = g (1 - beta (T - T_0)) along -z, on liquid only") {
  for (int dim : {2, 3}) {
    StageSetup s(dim, 1e-4);
    s.fill(Vec3::Zero(), Vec3::Constant(5e-4), 2000);
    s.add(Vec3(2.5e-4, 2.5e-4, dim == 3 ? 8.5e-4 : 0.0), 2000, false);
    s.prepare(Vec3::Zero(), Vec3::Constant(1e-3));
    s.set_temperature([](const Vec3& x) { return 1900 + 1e6 * x[0]; });
    const auto rates = [&](terms::Buoyancy b) {
      Components a = s.zeros();
      b.add_acceleration(s.stage, view(a));
      return a;
    };
    const auto both = rates({true, true, 9.80665}), plain = rates({true, false, 9.80665}),
               lift = rates({false, true, 9.80665}), none = rates({false, false, 9.80665});
    const int up = dim - 1;
    for (Index i = 0; i < s.patch.size(); ++i) {
      const double liquid = s.patch.liquid[i], beta = 1e-4, t0 = 1800;
      const double excess = 1900 + 1e6 * s.patch.x[0][i] - t0;
      CHECK(both[up][i] == Approx(-liquid * 9.80665 * (1 - beta * excess)));
      CHECK(plain[up][i] == -liquid * 9.80665);
      CHECK(lift[up][i] == Approx(liquid * 9.80665 * beta * excess));
      CHECK(none[up][i] == 0);
      CHECK(both[0][i] == 0);
    }
  }
}
