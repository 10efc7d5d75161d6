#pragma once
// Rocks and structures: bodies that keep their particles (paper 2.5).

#include <cmath>
#include <string>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// What elastic and rigid solids share.
struct SolidMaterial : MaterialSpec {
  double density = 0;            ///< rho_0, kg/m3
  std::string slip = "no_slip";  ///< no_slip | free_slip: water and soil on its surface
  double friction = 0;  ///< Coulomb coefficient of contacts; between two solids the smaller one
  double contact_damping =
      0;  ///< of approach in a contact, over rho_0 c_0; between two solids the mean of both

  std::string phase() const final { return "solid"; }
  virtual bool rigid() const = 0;
  /// Pressure of a contact over the density of Eq. 78 in parts of rho_0: rho_0 c_0^2, Pa.
  virtual double contact_stiffness() const = 0;
};

/// A hyperelastic solid (Eqs. 35 to 40).
struct Elastic final : SolidMaterial {
  double youngs_modulus = 0;        ///< E, Pa
  double poisson_ratio = 0.3;       ///< nu
  std::string law = "neo_hookean";  ///< neo_hookean | saint_venant_kirchhoff
  double damping = 0;               ///< by mass, 1/s: dv/dt = ... - damping v
  double viscosity_factor =
      0;  ///< alpha of an artificial viscosity alpha rho_0 c h between particles

  bool rigid() const override { return false; }
  double shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
  double bulk_modulus() const { return youngs_modulus / (3 * (1 - 2 * poisson_ratio)); }
  double lame() const { return bulk_modulus() - 2 * shear_modulus() / 3; }
  double contact_stiffness() const override { return bulk_modulus(); }
  /// Speed of compression waves, the fastest, m/s; c_0 of Eq. 53 is sqrt(K / rho_0).
  double wave_speed() const {
    return std::sqrt((bulk_modulus() + 4 * shear_modulus() / 3) / density);
  }
  static Schema<Elastic> schema();
};

/// A rigid solid: six degrees of freedom.
struct Rigid final : SolidMaterial {
  double stiffness = 1e7;  ///< of its contacts with solids and walls, Pa

  bool rigid() const override { return true; }
  double contact_stiffness() const override { return stiffness; }
  static Schema<Rigid> schema();
};

/// Declares the keys that all solids share.
template <class S>
void declare_solid_keys(Schema<S>& s) {
  s.required("density", &S::density, unit::density, "density rho_0 at rest")
      .above(0)
      .equation("Eq. 34");
  s.optional("slip", &S::slip, unit::none,
             "no_slip or free_slip condition for water and soil on its surface")
      .choices({"no_slip", "free_slip"});
  s.optional("friction", &S::friction, unit::none,
             "Coulomb friction coefficient of its contacts with walls and other solids; between "
             "two solids the smaller one")
      .at_least(0);
  s.optional(
       "contact_damping", &S::contact_damping, unit::none,
       "damping of approach in a contact, as a fraction of rho_0 c_0; between two solids the mean")
      .at_least(0)
      .at_most(2);
}

/// The material of a body, if that is a solid.
inline const SolidMaterial* solid_of(const Model& model, const Body& body) {
  return dynamic_cast<const SolidMaterial*>(model.material(body.material));
}
bool has_solids(const Model& model);

/// The spacings of solids, each once, in order of the bodies, m: the solids of each spacing have
/// their own particle set.
std::vector<double> solid_spacings(const Model& model);

/// The set of the solids of that spacing: "solids", "solids_2" ...
std::string solid_set_name(std::size_t spacing);

/// The set that holds the particles of a body, "" when it is no solid.
std::string solid_set_of(const Model& model, std::size_t body);

}  // namespace sphgeo
