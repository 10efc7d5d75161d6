#pragma once
// Soil: an elastic, perfectly plastic skeleton of grains (paper 2.2).

#include <optional>

#include "deck/interfaces.h"
#include "deck/schema.h"
#include "materials/drucker_prager.h"

namespace sphgeo {

/// Parameters of one soil. The grains do not change their density; the skeleton does.
struct Soil final : MaterialSpec {
  double density = 0;                         ///< of the grains, rho^s, kg/m3
  std::optional<double> volume_fraction;      ///< n^s at t = 0, unless a body gives its own
  std::optional<double> youngs_modulus;       ///< E of the skeleton, Pa; needed unless it is fixed
  double poisson_ratio = 0.3;                 ///< nu
  std::string plasticity = "drucker_prager";  ///< drucker_prager | none
  std::optional<double> friction_angle;       ///< phi, rad
  std::optional<double> friction;             ///< mu = tan phi, instead of the angle
  double cohesion = 0;                        ///< c, Pa
  std::optional<double> saturated_cohesion;   ///< c of Eq. 108 at full saturation, Pa
  double dilation_angle = 0;                  ///< psi, rad
  std::string cone =
      "plane_strain";  ///< plane_strain | compression | extension: where it meets Mohr and Coulomb
  std::string drag = "auto";         ///< auto | ergun | darcy | none, of water in the soil
  std::optional<double> grain_size;  ///< D_c of Eq. 31, m
  std::optional<double> hydraulic_conductivity;  ///< K^s of Eq. 29, m/s
  double drag_viscous = 150;                     ///< alpha_d of Eq. 31
  double drag_inertial = 1.75;                   ///< beta_d of Eq. 31
  std::string skeleton = "deformable";           ///< deformable | fixed | prescribed

  std::string phase() const override { return "soil"; }
  double bulk_modulus() const { return youngs_modulus.value_or(0) / (3 * (1 - 2 * poisson_ratio)); }
  double shear_modulus() const { return youngs_modulus.value_or(0) / (2 * (1 + poisson_ratio)); }
  /// Oedometric modulus: stiffness of a laterally confined column, Pa.
  double oedometric_modulus() const { return bulk_modulus() + 4 * shear_modulus() / 3; }
  bool elastic() const { return plasticity == "none"; }
  /// The drag law: ergun, darcy or none; `auto` follows from the given keys.
  std::string drag_law() const {
    if (drag != "auto") return drag;
    return hydraulic_conductivity ? "darcy" : grain_size ? "ergun" : "none";
  }
  bool moves_by_forces() const { return skeleton == "deformable"; }
  double tan_friction() const;
  /// Constants of the stress point with the cohesion at the degree of saturation S_r (Eq. 108).
  DruckerPrager<double> constants(double saturation = 0) const;
  /// Horizontal over vertical stress at rest: 1 - sin phi (Jaky), or nu / (1 - nu) of an elastic
  /// soil.
  double pressure_at_rest() const;
  static Schema<Soil> schema();
};

}  // namespace sphgeo
