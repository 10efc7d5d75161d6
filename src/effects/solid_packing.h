#pragma once
// Packed records of elastic solids. Their positions are those at rest, written once by
// solid_correction.

#include <algorithm>

#include "sph/record_type.h"

namespace sphgeo::packed {

/// What a body has moved beyond its rigid motion, for the deformation gradient; of each effect that
/// asks for it.
template <int Dim>
struct Displacement : RecordType<Dim> {
  static constexpr RecordField<Displacement, 0, Dim> position{};      ///< at rest
  static constexpr RecordField<Displacement, 4, Dim> displacement{};  ///< w, see Deformation, m
  static constexpr RecordSpec spec{"displacement",
                                   0,
                                   "displacement of solids beyond their rigid motion",
                                   {{{"position", position}, {"displacement", displacement}}}};
};

/// Numbers of P . B by rows that fit behind the position.
template <int Dim>
inline constexpr int first_piola_numbers = std::min(Dim* Dim, 8 - Dim);

/// The stress P . B of solid_predict, by rows.
template <int Dim>
struct Piola : RecordType<Dim> {
  static constexpr RecordField<Piola, 0, Dim> position{};                        ///< at rest
  static constexpr RecordField<Piola, Dim, first_piola_numbers<Dim>> numbers{};  ///< Pa
  static constexpr RecordSpec spec{
      "piola", 1, "stress of solids", {{{"position", position}, {"numbers", numbers}}}};
};

/// Its last numbers, in 3D.
struct PiolaRest : RecordType<3> {
  static constexpr RecordField<PiolaRest, 0, 9 - first_piola_numbers<3>> numbers{};  ///< Pa
  static constexpr RecordSpec spec{
      "piola_rest", 2, "last numbers of the stress of solids", {{{"numbers", numbers}}}};
};

/// What the viscosity of solids needs of their motion; kept by solid_predict.
template <int Dim>
struct SolidMotion : RecordType<Dim> {
  static constexpr RecordField<SolidMotion, 0, Dim> displacement{};  ///< x - X, m
  static constexpr RecordField<SolidMotion, 3, Dim> velocity{};      ///< m/s
  static constexpr RecordSpec spec{"solid_motion",
                                   Dim,  // behind those of the stress
                                   "displacement and velocity of solids, for their viscosity",
                                   {{{"displacement", displacement}, {"velocity", velocity}}}};
};

}  // namespace sphgeo::packed
