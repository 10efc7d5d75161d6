#pragma once
// Packed records of the soil. Passes over soil of one kind read two records; the third (in 2D the
// second) holds what else unlike soils and walls need.

#include <type_traits>

#include "sph/record_type.h"

namespace sphgeo::packed {

/// State of the soil at the middle of the acoustic step, kept by soil_predict; soil_kick brings the
/// velocity to its end.
template <int Dim>
struct SoilState;

template <>
struct SoilState<2> : RecordType<2, Position<2>> {
  static constexpr RecordField<SoilState, 3> volume{};       ///< V, m2
  static constexpr RecordField<SoilState, 4, 2> velocity{};  ///< v, m/s
  /// Share of its weight that the skeleton bears itself: less than 1 in water.
  static constexpr RecordField<SoilState, 6> borne{};
  static constexpr RecordSpec spec{
      "soil_state",
      0,
      "volume and velocity of the soil in the acoustic step",
      {{{"volume", volume}, {"velocity", velocity}, {"borne", borne}}}};
};

template <>
struct SoilState<3> : RecordType<3, Position<3>> {
  static constexpr RecordField<SoilState, 3> volume{};       ///< V, m3
  static constexpr RecordField<SoilState, 4, 3> velocity{};  ///< v, m/s
  static constexpr RecordField<SoilState, 7> stress_zz{};    ///< the last number of SoilStress
  static constexpr RecordSpec spec{
      "soil_state",
      0,
      "volume and velocity of the soil in the acoustic step",
      {{{"volume", volume}, {"velocity", velocity}, {"stress_zz", stress_zz}}}};
};

/// Its stress sigma . B by rows (see soil_momentum); kept with it.
template <int Dim>
struct SoilStress;

template <>
struct SoilStress<2> : RecordType<2> {
  static constexpr RecordField<SoilStress, 0, 4> stress{};  ///< Pa
  /// P' = -tr(sigma)/3 of Eq. 51, three-dimensional also in plane strain, Pa.
  static constexpr RecordField<SoilStress, 4> pressure{};
  static constexpr RecordField<SoilStress, 5> density{};    ///< rho_0 of the part, kg/m3
  static constexpr RecordField<SoilStress, 6> impedance{};  ///< rho_0 c_0 of the part, Pa s/m
  /// mu = tan phi of the part, between soil and rough walls.
  static constexpr RecordField<SoilStress, 7> friction{};
  static constexpr RecordSpec spec{"soil_stress",
                                   1,
                                   "stress and parameters of the soil in the acoustic step",
                                   {{{"stress", stress},
                                     {"pressure", pressure},
                                     {"density", density},
                                     {"impedance", impedance},
                                     {"friction", friction}}}};
};

template <>
struct SoilStress<3> : RecordType<3> {
  static constexpr RecordField<SoilStress, 0, 8> stress{};  ///< all numbers but the last, Pa
  static constexpr RecordSpec spec{
      "soil_stress", 1, "stress of the soil in the acoustic step", {{{"stress", stress}}}};
};

/// What unlike soils and walls need beside them in 3D; kept with them.
struct SoilMaterial : RecordType<3> {
  static constexpr RecordField<SoilMaterial, 0> pressure{};   ///< P', Pa
  static constexpr RecordField<SoilMaterial, 1> density{};    ///< rho_0 of the part, kg/m3
  static constexpr RecordField<SoilMaterial, 2> impedance{};  ///< rho_0 c_0, Pa s/m
  static constexpr RecordField<SoilMaterial, 3> friction{};   ///< mu = tan phi of the part
  static constexpr RecordField<SoilMaterial, 4> borne{};      ///< as in 2D
  static constexpr RecordSpec spec{"soil_material",
                                   2,
                                   "parameters of the soil for unlike soils and walls",
                                   {{{"pressure", pressure},
                                     {"density", density},
                                     {"impedance", impedance},
                                     {"friction", friction},
                                     {"borne", borne}}}};
};

/// The record with pressure, density, impedance and friction, and that with the share of the weight
/// borne by the skeleton.
template <int Dim>
using SoilContact = std::conditional_t<Dim == 2, SoilStress<2>, SoilMaterial>;
template <int Dim>
using SoilWeight = std::conditional_t<Dim == 2, SoilState<2>, SoilMaterial>;

/// What soil_reinitialization sums over.
template <int Dim>
struct RestingSoil : RecordType<Dim, Position<Dim>> {
  static constexpr RecordField<RestingSoil, 3> volume{};      ///< at rest, m^Dim
  static constexpr RecordField<RestingSoil, 7> on_surface{};  ///< 1 on the free surface, else 0
  static constexpr RecordSpec spec{"resting_soil",
                                   0,
                                   "soil at its volume fraction at rest",
                                   {{{"volume", volume}, {"on_surface", on_surface}}}};
};

}  // namespace sphgeo::packed
