#pragma once
// Water: weakly compressible, Newtonian (paper 2.3).

#include <optional>

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// Parameters of the water phase. Equation of state p = c0^2 (rho - rho0) (Eq. 26).
struct Water final : MaterialSpec {
  double density = 1000.0;            ///< rho0, kg/m3
  double viscosity = 1e-3;            ///< eta, Pa s
  std::optional<double> sound_speed;  ///< c0, m/s; 10 x max_speed when absent
  std::optional<double> max_speed;    ///< anticipated largest speed, m/s; estimated when absent

  std::string phase() const override { return "water"; }
  static Schema<Water> schema();
};

}  // namespace sphgeo
