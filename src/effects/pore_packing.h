#pragma once
// Packed records of pairs of water and soil, in an array of their own of both sets: these pairs use
// positions of the last rearrangement, whatever the others use.

#include "sph/record_type.h"

namespace sphgeo::packed {

/// Position and weight in the means of both phases, for the whole advection step; kept by
/// water_fraction.
template <int Dim>
struct Pore : RecordType<Dim> {
  static constexpr RecordField<Pore, 0, Dim> position{};  ///< at the last rearrangement
  /// Of soil: omega; of water: 1 / sum(omega W), see pore_water.h.
  static constexpr RecordField<Pore, 3> weight{};
  static constexpr RecordSpec spec{"pore",
                                   3,
                                   "position and weight in pairs of water and soil",
                                   {{{"position", position}, {"weight", weight}}}};
};

/// Velocity of the soil, of which the water sees the mean.
template <int Dim>
struct PoreVelocity : RecordType<Dim, Pore<Dim>> {
  static constexpr RecordField<PoreVelocity, 4, Dim> vector{};  ///< m/s
  static constexpr RecordSpec spec{
      "pore_velocity", 3, "velocity of the soil that the water sees", {{{"vector", vector}}}};
};

/// Force of the water on the soil around it.
template <int Dim>
struct PoreForce : RecordType<Dim, Pore<Dim>> {
  static constexpr RecordField<PoreForce, 4, Dim> vector{};  ///< N
  static constexpr RecordSpec spec{
      "pore_force", 3, "force of the water that is spread to the soil", {{{"vector", vector}}}};
};

/// What water_fraction sums up of the soil.
template <int Dim>
struct SoilDrag : RecordType<Dim, Pore<Dim>> {
  /// Eq. 29 times (n^w)^2, and the two terms of Eq. 31.
  static constexpr RecordField<SoilDrag, 4, 3> coefficients{};
  static constexpr RecordField<SoilDrag, 7> volume{};  ///< V, m^Dim
  static constexpr RecordSpec spec{"soil_drag",
                                   3,
                                   "coefficients of the drag, and volume of the soil",
                                   {{{"coefficients", coefficients}, {"volume", volume}}}};
};

/// How much a unit impulse on the water around moves the soil, in water_fraction.
template <int Dim>
struct SoilMobility : RecordType<Dim, Pore<Dim>> {
  static constexpr RecordField<SoilMobility, 7> per_mass{};  ///< 1/kg
  static constexpr RecordSpec spec{
      "soil_mobility", 3, "how the soil follows impulses on the water", {{{"per_mass", per_mass}}}};
};

/// Volume of the water in soil_saturation.
template <int Dim>
struct PoreVolume : RecordType<Dim, Pore<Dim>> {
  static constexpr RecordField<PoreVolume, 7> volume{};  ///< m / (n^w rho), m^Dim
  static constexpr RecordSpec spec{
      "pore_volume", 3, "volume of the water in the pores", {{{"volume", volume}}}};
};

}  // namespace sphgeo::packed
