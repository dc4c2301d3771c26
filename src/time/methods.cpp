// SPDX-License-Identifier: MIT
#include "time/methods.hpp"

#include <arkode/arkode_butcher_dirk.h>
#include <arkode/arkode_butcher_erk.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <new>
#include <numbers>

#include "meltray/core/errors.hpp"

namespace meltray::integration {
namespace {

Table checked(ARKodeButcherTable t) {
  if (t == nullptr) throw std::bad_alloc();
  return Table(t);
}

template <std::size_t S>
Table make(int order, int embedding, std::array<double, S> c, std::array<double, S * S> a,
           std::array<double, S> b, std::array<double, S> d) {
  return checked(ARKodeButcherTable_Create(static_cast<int>(S), order, embedding, c.data(), a.data(),
                                           b.data(), d.data()));
}

/// ARS(2,2,2) of Ascher, Ruuth and Spiteri 1997, sect. 2.6: L-stable and stiffly accurate implicit half.
/// Its second stage, taken for all of the step, serves as first-order comparison for the error estimate.
Tableau ars222() {
  const double g = 1 - 1 / std::numbers::sqrt2;
  const double d = 1 - 1 / (2 * g);
  Tableau m;
  m.order = 2;
  m.embedding_order = 1;
  m.explicit_half = make<3>(2, 1, {0, g, 1}, {0, 0, 0, g, 0, 0, d, 1 - d, 0}, {d, 1 - d, 0}, {0, 1, 0});
  m.implicit_half = make<3>(2, 1, {0, g, 1}, {0, 0, 0, 0, g, 0, 0, 1 - g, g}, {0, 1 - g, g}, {0, 1, 0});
  return m;
}

/// TR-BDF2 as a Runge-Kutta pair (Hosea and Shampine 1996, sect. 3). ARKODE's own table of that name goes on
/// with the third-order weights, which are not L-stable; here they only give the error estimate.
Tableau trbdf2() {
  const double g = 2 - std::numbers::sqrt2, d = g / 2, w = std::numbers::sqrt2 / 4;
  Tableau m;
  m.order = 2;
  m.embedding_order = 3;
  m.implicit_half =
      make<3>(2, 3, {0, g, 1}, {0, 0, 0, d, d, 0, w, w, d}, {w, w, d}, {(1 - w) / 3, (3 * w + 1) / 3, d / 3});
  return m;
}

Tableau library(ARKODE_DIRKTableID implicit_id, ARKODE_ERKTableID explicit_id) {
  Tableau m;
  if (implicit_id != ARKODE_DIRK_NONE) m.implicit_half = checked(ARKodeButcherTable_LoadDIRK(implicit_id));
  if (explicit_id != ARKODE_ERK_NONE) m.explicit_half = checked(ARKodeButcherTable_LoadERK(explicit_id));
  const auto& half = m.implicit_half ? m.implicit_half : m.explicit_half;
  m.order = half->q;
  m.embedding_order = half->p;
  return m;
}

[[noreturn]] void no_such_order(Method method, int order) {
  throw UsageError(fmt::format("method '{}' has no order {} (allowed: 2, 3, 4, 5)", name_of(method), order));
}

/// Additive pairs of Kennedy and Carpenter 2003.
Tableau imex(int order) {
  switch (order) {
    case 2:
      return ars222();
    case 3:
      return library(ARKODE_ARK324L2SA_DIRK_4_2_3, ARKODE_ARK324L2SA_ERK_4_2_3);
    case 4:
      return library(ARKODE_ARK436L2SA_DIRK_6_3_4, ARKODE_ARK436L2SA_ERK_6_3_4);
    case 5:
      return library(ARKODE_ARK548L2SA_DIRK_8_4_5, ARKODE_ARK548L2SA_ERK_8_4_5);
    default:
      no_such_order(Method::imex, order);
  }
}

/// Heun-Euler, Bogacki-Shampine, Zonneveld, Cash-Karp.
Tableau explicit_rk(int order) {
  switch (order) {
    case 2:
      return library(ARKODE_DIRK_NONE, ARKODE_HEUN_EULER_2_1_2);
    case 3:
      return library(ARKODE_DIRK_NONE, ARKODE_BOGACKI_SHAMPINE_4_2_3);
    case 4:
      return library(ARKODE_DIRK_NONE, ARKODE_ZONNEVELD_5_3_4);
    case 5:
      return library(ARKODE_DIRK_NONE, ARKODE_CASH_KARP_6_4_5);
    default:
      no_such_order(Method::explicit_rk, order);
  }
}

/// TR-BDF2, then stiffly accurate ESDIRK methods of Kennedy and Carpenter 2016 and 2019.
Tableau implicit_rk(int order) {
  switch (order) {
    case 2:
      return trbdf2();
    case 3:
      return library(ARKODE_ESDIRK324L2SA_4_2_3, ARKODE_ERK_NONE);
    case 4:
      return library(ARKODE_ESDIRK436L2SA_6_3_4, ARKODE_ERK_NONE);
    case 5:
      return library(ARKODE_ESDIRK547L2SA2_7_4_5, ARKODE_ERK_NONE);
    default:
      no_such_order(Method::implicit_rk, order);
  }
}

}  // namespace

Tableau tableau(Method method, int order) {
  switch (method) {
    case Method::imex:
      return imex(order);
    case Method::explicit_rk:
      return explicit_rk(order);
    case Method::implicit_rk:
      return implicit_rk(order);
    case Method::multirate:
      if (order != 3 && order != 4)
        throw UsageError(fmt::format("method 'multirate' has no order {} (allowed: 3, 4)", order));
      return explicit_rk(order);
    default:
      throw UsageError(fmt::format("method '{}' has no Butcher table", name_of(method)));
  }
}

bool stage_unused(const ARKodeButcherTableMem& table, int stage, bool with_embedding) {
  if (table.b[stage] != 0 || (with_embedding && table.d[stage] != 0)) return false;
  for (int i = stage; i < table.stages; ++i)
    if (table.A[i][stage] != 0) return false;
  return true;
}

}  // namespace meltray::integration
