#pragma once
// What the deck says to the running scene, compiled once when the scene is built: plain numbers in
// SI units, choices, and pointers to the formulas, motions and shapes that are asked while it runs.
// Those belong to the deck's model, which outlives the scene.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace sphgeo {

class Expression;
struct Motion;
struct Shape;

/// Three formulas of position and time.
using VectorFormula = std::array<Expression, 3>;

/// Arithmetic of pair sums.
enum class PairPrecision { single, full };
/// Whether pair sums see positions of the last rearrangement or of now.
enum class PairGeometry { frozen, current };
/// How the density of water is found anew once per advection step.
enum class DensityReinitialization { summation, shepard, none };
/// What the transport displacement does at a free surface.
enum class SurfaceTransport { none, tangential };
/// How the velocity gradient of soil is summed (Eq. 55).
enum class VelocityGradient { corrected, plain };
/// Fields whose gradient is exact in solids at rest.
enum class SolidGradient { linear, quadratic };
/// What happens to particles outside of the domain.
enum class OutsideDomain { remove, stop };
/// Drag of water in soil (Eqs. 29, 31).
enum class DragLaw { none, darcy, ergun };

/// Choices of the numerical method; see deck/model.h for the keys.
struct NumericsParameters {
  PairPrecision pair_precision = PairPrecision::single;
  PairGeometry pair_geometry = PairGeometry::frozen;
  PairGeometry soil_pair_geometry = PairGeometry::current;
  double cfl_acoustic = 0.4;
  double cfl_advection = 0.2;
  double cfl_solid = 0.6;
  double time_step_factor = 1;
  double advection_ratio_max = 5.5;
  DensityReinitialization density_reinitialization = DensityReinitialization::summation;
  bool transport_velocity = true;
  bool transport_velocity_soil = false;
  double transport_coefficient = 0.2;  ///< alpha of Eq. 87
  SurfaceTransport transport_at_surface = SurfaceTransport::none;
  bool transport_target_volume = true;
  bool transport_projection = true;
  double transport_projection_threshold = 0.1;  ///< gamma_p of Eq. 89
  VelocityGradient soil_velocity_gradient = VelocityGradient::corrected;
  bool volume_fraction_by_summation = true;
  SolidGradient solid_gradient = SolidGradient::linear;
  double water_fraction_floor = 0.05;  ///< least n^w of Eq. 56
  double density_bound = 0.5;          ///< largest |rho / rho0 - 1|
  double max_lost_fraction = 0.01;
  OutsideDomain outside = OutsideDomain::remove;
};

/// The water; p = c0^2 (rho - rho0) (Eq. 26).
struct WaterParameters {
  double density = 0;      ///< rho0, kg/m3
  double sound_speed = 0;  ///< c0, m/s
  double viscosity = 0;    ///< eta, Pa s
  double limiter = 0;      ///< xi of Eq. 63
  /// Whether its volume follows the porosity of soil (Eq. 27).
  bool follows_porosity = false;
};

/// Constants of the stress point of soil, see DruckerPrager.
struct StressPointParameters {
  double bulk = 0;      ///< K, Pa
  double shear = 0;     ///< G, Pa
  double friction = 0;  ///< alpha_phi
  double dilation = 0;  ///< alpha_psi
  double strength = 0;  ///< k_c, Pa
  double apex = 0;      ///< largest I1, Pa
};

/// One body, as a part of the soil.
struct SoilPart {
  bool is_soil = false;
  bool moves = false;        ///< by forces
  bool fixed = false;        ///< never moves
  double grain_density = 0;  ///< rho^s, kg/m3
  double density = 0;      ///< rho_0 of the skeleton: rho^s times its mean volume fraction at t = 0
  double sound_speed = 0;  ///< c_0 of Eq. 53, m/s
  double wave_speed = 0;   ///< of compression waves: sqrt((K + 4 G / 3) / rho_0), m/s
  double friction = 0;     ///< tan phi
  StressPointParameters constants;  ///< dry
  double wet_strength = 0;          ///< k_c at full saturation, Pa
  DragLaw drag = DragLaw::none;
  double hydraulic_conductivity = 0;        ///< K^s of Eq. 29, m/s; with Darcy's law
  double grain_size = 0;                    ///< D_c of Eq. 31, m; with Ergun's law
  double drag_viscous = 0;                  ///< alpha_d of Eq. 31
  double drag_inertial = 0;                 ///< beta_d of Eq. 31
  const VectorFormula* velocity = nullptr;  ///< of the body, m/s: a prescribed skeleton follows it

  double impedance() const { return density * sound_speed; }
};

/// All parts of the soil, by index of the body.
struct SoilParameters {
  std::vector<SoilPart> of;
  bool uniform = true;  ///< all soil is of one impedance and density: the pair flux needs no table
  bool deformable = false;  ///< some soil moves by forces
  bool any_moves = false;   ///< some soil moves: by forces or as prescribed
  SoilPart first;           ///< of the first body of soil
  double fastest = 0;       ///< largest speed of sound of soil that moves by forces, m/s
  double fastest_wave = 0;  ///< the same of compression waves, m/s
  double limiter = 0;       ///< xi^s of Eq. 54

  const SoilPart& operator[](std::int32_t part) const { return of[static_cast<std::size_t>(part)]; }
};

/// A clamped region of a solid.
struct ClampPart {
  const Shape* shape = nullptr;
  const Motion* motion = nullptr;  ///< null: it rests
};

/// One body, as a part of the solids.
struct SolidPart {
  bool is_solid = false;
  bool elastic = false;  ///< a solid that is not rigid
  std::string set;       ///< that holds its particles; "" when it is no solid
  double density = 0;    ///< rho_0, kg/m3
  double shear = 0;      ///< mu = G, Pa
  double lame = 0;       ///< lambda, Pa
  bool neo_hookean = true;
  double wave_speed = 0;         ///< of compression waves, m/s
  double damping = 0;            ///< by mass, 1/s
  double viscosity = 0;          ///< alpha rho_0 c, Pa s/m
  double contact_stiffness = 0;  ///< rho_0 c_0^2, Pa
  double contact_damping = 0;    ///< in parts of rho_0 c_0
  double friction = 0;           ///< Coulomb coefficient of contacts
  bool self_contact = false;
  const Shape* shape = nullptr;  ///< at t = 0
  std::vector<ClampPart> clamped;

  bool rigid() const { return is_solid && !elastic; }
};

/// All parts of the solids, by index of the body.
struct SolidParameters {
  std::vector<SolidPart> of;
  const SolidPart& operator[](std::int32_t part) const {
    return of[static_cast<std::size_t>(part)];
  }
};

/// What of a boundary moves its particles.
struct BoundaryMotion {
  std::string name;
  const Motion* motion = nullptr;  ///< null: it rests, or is no wall
  bool absorbs_waves = false;      ///< active wave absorption is on
};

/// Layers of water that enter through a flat rectangle.
struct InletParameters {
  std::string name;
  std::vector<Vec3> layer;                  ///< positions of one layer, by rows, m
  int across = 0;                           ///< axis that the water crosses
  double direction = 1;                     ///< along it, 1 or -1
  const VectorFormula* velocity = nullptr;  ///< m/s
  double share = 1;                         ///< of the positions that get a particle
  std::uint64_t seed = 0;
  double from = 0;  ///< s
  std::optional<double> until;
};

/// Water that is added where a surface sinks.
struct ReservoirParameters {
  std::string name;
  std::vector<Vec3> positions;  ///< where water may be added, m
};

/// A region in which particles are taken out.
struct OutletParameters {
  std::string name;
  const Shape* shape = nullptr;
  std::vector<std::string> sets;
};

/// Name of a body or boundary, and where the deck defines it, as "deck.yaml:12:5".
struct Origin {
  std::string name, location;
};

/// The whole table. Immutable once the scene is built.
struct Parameters {
  Vec3 gravity = Vec3::Zero();                ///< m/s2
  const VectorFormula* body_force = nullptr;  ///< further acceleration, m/s2; null: none
  std::string body_force_location;            ///< where the deck gives it
  NumericsParameters numerics;
  WaterParameters water;
  SoilParameters soil;
  SolidParameters solids;
  std::vector<BoundaryMotion> boundary_motions;  ///< by number of the boundary
  std::vector<InletParameters> inlets;
  std::vector<ReservoirParameters> reservoirs;
  std::vector<OutletParameters> outlets;
  std::vector<std::string> without;        ///< effects that are switched off
  std::vector<Origin> bodies, boundaries;  ///< of the deck, by number
  /// Shortest interval at which a probe or the run's table is written, s.
  double shortest_interval = std::numeric_limits<double>::infinity();
};

}  // namespace sphgeo
