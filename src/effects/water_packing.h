#pragma once
// Packed records of the water. Array 0 holds the state within the acoustic steps; the passes of the
// reinitialize stage, before them, use it for themselves.

#include "sph/record_type.h"

namespace sphgeo::packed {

/// State of the water at the middle of the acoustic step, kept by water_predict; water_kick brings
/// the velocity to its end, water_pressure packs it for observers.
template <int Dim>
struct WaterState : RecordType<Dim, Position<Dim>> {
  static constexpr RecordField<WaterState, 3>
      volume{};  ///< V (Eq. 27) times gradient_scale(), m^Dim
  static constexpr RecordField<WaterState, 4, Dim> velocity{};  ///< v, m/s
  static constexpr RecordField<WaterState, 7> pressure{};       ///< p (Eq. 26), Pa
  static constexpr RecordSpec spec{
      "water_state",
      0,
      "state of the water in the acoustic step",
      {{{"volume", volume}, {"velocity", velocity}, {"pressure", pressure}}}};
};

/// The velocity of the mixture of water and soil for the rate of density, kept by soil_velocity in
/// place of that of the water.
template <int Dim>
struct Mixture : RecordType<Dim, WaterState<Dim>> {
  static constexpr RecordField<Mixture, 4, Dim> velocity{};  ///< n^w v^w + n^s v^s, m/s
  static constexpr RecordSpec spec{
      "mixture", 0, "velocity of the mixture of water and soil", {{{"velocity", velocity}}}};
};

/// The volume of the water for observers, kept by water_pressure.
template <int Dim>
struct ObservedWater : RecordType<Dim, WaterState<Dim>> {
  static constexpr RecordField<ObservedWater, 3> volume{};  ///< V (Eq. 27), m^Dim
  static constexpr RecordSpec spec{
      "observed_water", 0, "volume of the water for observers", {{{"volume", volume}}}};
};

/// What water_reinitialization sums over.
template <int Dim>
struct RestingWater : RecordType<Dim, Position<Dim>> {
  static constexpr RecordField<RestingWater, 3> volume{};    ///< at rest: m / (rho0 n^w), m^Dim
  static constexpr RecordField<RestingWater, 4> swelling{};  ///< of the transport, over `volume`
  static constexpr RecordField<RestingWater, 7> fraction{};  ///< n^w
  static constexpr RecordSpec spec{
      "resting_water",
      0,
      "water at the density at rest",
      {{{"volume", volume}, {"swelling", swelling}, {"fraction", fraction}}}};
};

/// What density_filter sums over.
template <int Dim>
struct DensityDeviation : RecordType<Dim, Position<Dim>> {
  static constexpr RecordField<DensityDeviation, 3> volume{};     ///< V (Eq. 27), m^Dim
  static constexpr RecordField<DensityDeviation, 7> deviation{};  ///< rho / rho0 - 1
  static constexpr RecordSpec spec{"density_deviation",
                                   0,
                                   "density of the water that is filtered",
                                   {{{"volume", volume}, {"deviation", deviation}}}};
};

/// The free surface, between the two walks of water_reinitialization.
template <int Dim>
struct FreeSurface : RecordType<Dim> {
  static constexpr RecordField<FreeSurface, 0, Dim> normal{};
  static constexpr RecordField<FreeSurface, 4> on_surface{};     ///< 1 on it, else 0
  static constexpr RecordField<FreeSurface, 5, Dim> gradient{};  ///< sum of grad W V, 1/m
  static constexpr RecordSpec spec{
      "free_surface",
      1,
      "free surface of the water, and what its particles are shifted by",
      {{{"normal", normal}, {"on_surface", on_surface}, {"gradient", gradient}}}};
};

/// What pairs of water and walls, or the interface particles of solids, need beside the state.
template <int Dim>
struct PressureGradient : RecordType<Dim> {
  static constexpr RecordField<PressureGradient, 0, Dim> over_density{};  ///< g - dv/dt, m/s2
  static constexpr RecordField<PressureGradient, 4> density{};            ///< rho, kg/m3
  /// What gradient_scale() makes of the reaction beside the volume in the first record.
  static constexpr RecordField<PressureGradient, 5> reaction_scale{};
  static constexpr RecordSpec spec{
      "pressure_gradient",
      1,
      "pressure gradient over density of the last step, for walls",
      {{{"over_density", over_density}, {"density", density}, {"reaction_scale", reaction_scale}}}};
};

}  // namespace sphgeo::packed
