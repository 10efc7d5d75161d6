#pragma once
// Packed records of walls and of the interface particles of solids (the sets "walls" and
// "interface").

#include "sph/record_type.h"

namespace sphgeo::packed {

/// Kept by wall_state and interface_state; wall_motion and interface_follow bring it to the end of
/// the acoustic step.
template <int Dim>
struct Wall : RecordType<Dim, Position<Dim>> {
  static constexpr RecordField<Wall, 3> volume{};         ///< V, m^Dim
  static constexpr RecordField<Wall, 4, Dim> velocity{};  ///< v, m/s
  static constexpr RecordField<Wall, 7> no_slip{};        ///< 1 = no slip, 0 = free slip
  static constexpr RecordSpec spec{
      "wall",
      0,
      "volume, velocity and slip of wall particles",
      {{{"volume", volume}, {"velocity", velocity}, {"no_slip", no_slip}}}};
};

/// Kept with it.
template <int Dim>
struct WallSurface : RecordType<Dim> {
  static constexpr RecordField<WallSurface, 0, Dim> normal{};  ///< n, outward from the solid
  /// For soil: 0 on a smooth wall in a concave corner, elsewhere 1.
  static constexpr RecordField<WallSurface, 3> face{};
  /// (dv/dt - g) . n of the wall, not below its value at rest or zero, m/s2.
  static constexpr RecordField<WallSurface, 4> push{};
  static constexpr RecordField<WallSurface, 5> weight{};  ///< -g . n, m/s2
  /// 1 where the surface of a solid moves with the water, 0 for walls.
  static constexpr RecordField<WallSurface, 6> deformable{};
  /// Of solids, distance below which water is too close, m; 0 for walls.
  static constexpr RecordField<WallSurface, 7> near{};
  static constexpr RecordSpec spec{"wall_surface",
                                   1,
                                   "normal and push of wall particles",
                                   {{{"normal", normal},
                                     {"face", face},
                                     {"push", push},
                                     {"weight", weight},
                                     {"deformable", deformable},
                                     {"near", near}}}};
};

}  // namespace sphgeo::packed
