#pragma once
// What the effects of the soil phase share: parameters of its parts, record layout, the Riemann flux.

#include <cmath>
#include <vector>

#include "effects/lattice_sums.h"
#include "effects/water_phase.h"
#include "materials/soil.h"
#include "sph/gather.h"
#include "sph/kernel.h"
#include "sph/world.h"

namespace sphgeo {

/// Parameters of one part (body) of the soil, SI.
struct SoilPart {
  const Soil* material = nullptr;  ///< null for a body that is no soil
  double grain_density = 0;        ///< rho^s
  double density = 0;              ///< rho_0 of the skeleton: rho^s times its mean volume fraction at t = 0
  double sound_speed = 0;          ///< c_0 of Eq. 53
  DruckerPrager<double> constants{};  ///< of the stress point, dry
  double wet_strength = 0;         ///< k_c at full saturation
  double impedance() const { return density * sound_speed; }
};

/// Parameters of all parts, by index of the body.
struct SoilParts {
  std::vector<SoilPart> of;
  bool uniform = true;       ///< all soil is of one impedance and density: the pair flux needs no table
  bool deformable = false;   ///< some soil moves by forces
  SoilPart first;            ///< of the first body of soil
  double fastest = 0;        ///< largest speed of sound of soil that moves by forces

  template <int Dim>
  explicit SoilParts(const World<Dim>& world) {
    const ParticleSet<Dim>& soil = world.set("soil");
    for (std::size_t b = 0; b < world.model().bodies.size(); ++b) {
      SoilPart part;
      part.material = dynamic_cast<const Soil*>(world.model().material(world.model().bodies[b].material));
      if (part.material) {
        part.grain_density = part.material->density;
        part.density = soil.constant("density." + std::to_string(b));
        part.sound_speed = std::sqrt(part.material->bulk_modulus() / part.density);
        part.constants = part.material->constants();
        part.wet_strength = part.material->constants(1.0).strength;
        if (!first.material) first = part;
        uniform = uniform && part.density == first.density && part.sound_speed == first.sound_speed;
        deformable = deformable || part.material->moves_by_forces();
        if (part.material->moves_by_forces()) fastest = std::max(fastest, part.sound_speed);
      }
      of.push_back(part);
    }
  }
  const SoilPart& operator[](std::int32_t part) const { return of[static_cast<std::size_t>(part)]; }
};

/// The kernel of the soil. Its gradient is divided by the lattice moment, 0.974 in 2D and 0.979 in 3D for h = 1.3 dp:
/// that is how much too weak a gradient the bare sums see, and by which the stress at rest would
/// exceed the weight at any resolution. The factor is one number for all pairs, so momentum stays exact.
template <int Dim>
Kernel<Dim> soil_kernel(const ParticleSet<Dim>& soil) {
  Kernel<Dim> kernel(soil.smoothing_length());
  kernel.slope /= lattice_sums(kernel, soil.spacing()).moment;
  return kernel;
}

/// xi^s of Eq. 54.
template <int Dim>
double soil_limiter(const World<Dim>& world) {
  return world.model().numerics.limiter_soil.value_or(20.0 * Dim);
}

/// Slots of a soil record behind the position. Volume and velocity sit where the water has them.
namespace soil_slot {
inline constexpr int volume = 3;           ///< V
inline constexpr int velocity = 4;         ///< v, Dim numbers
inline constexpr int volume_fraction = 7;  ///< n^s
inline constexpr int stress = 8;           ///< second record: xx, yy, zz, xy, yz, xz in 3D; xx, zz, xz, yy in 2D
inline constexpr int density = 14;         ///< rho_0 of the part; second record
inline constexpr int impedance = 15;       ///< rho_0 c_0 of the part; second record
inline constexpr int strain_rate = 16;     ///< D of the last step, ordered as the stress; third record
inline constexpr int pull = 16;            ///< g - dv/dt of the last step; in the record for walls, third in their sums
inline constexpr int present_density = 19; ///< n^s rho^s now; in the record for walls
}  // namespace soil_slot

/// Numbers of the record arrays of the soil.
namespace soil_record {
inline constexpr int motion = 0, stress = 1, strain_rate = 2, for_walls = 3;
}

/// Writes a stress (or a strain rate) to a second (third) record (`slot` as the array of its own 8 numbers).
template <int Dim, class T>
void pack_stress(const Sym3& stress, T* slot) {
  if constexpr (Dim == 3) {
    for (int k = 0; k < 6; ++k) slot[k] = static_cast<T>(stress[k]);
  } else {
    slot[0] = static_cast<T>(stress[0]);
    slot[1] = static_cast<T>(stress[2]);
    slot[2] = static_cast<T>(stress[5]);
    slot[3] = static_cast<T>(stress[1]);
  }
}

/// Mean pressure P' = -tr(sigma)/3 of a record, three-dimensional also in plane strain.
template <int Dim, class T, int N>
T mean_pressure(const Record<Dim, T, N>& i) {
  using soil_slot::stress;
  return T(-1.0 / 3.0) * (i[stress] + i[stress + 1] + i[Dim == 3 ? stress + 2 : stress + 3]);
}

/// sigma . r with the components a of a stress in the order of a record.
template <class T>
LaneVec<2, T> times(const T* a, const LaneVec<2, T>& r) {
  LaneVec<2, T> f;
  f[0] = a[0] * r[0] + a[2] * r[1];
  f[1] = a[2] * r[0] + a[1] * r[1];
  return f;
}
template <class T>
LaneVec<3, T> times(const T* a, const LaneVec<3, T>& r) {
  LaneVec<3, T> f;
  f[0] = a[0] * r[0] + a[3] * r[1] + a[5] * r[2];
  f[1] = a[3] * r[0] + a[1] * r[1] + a[4] * r[2];
  f[2] = a[5] * r[0] + a[4] * r[1] + a[2] * r[2];
  return f;
}
/// Numbers of a record's stress that sigma . r needs.
template <int Dim>
inline constexpr int stress_size = Dim == 3 ? 6 : 3;

/// Inverse of a moment sum(r (x) grad W V) given by its upper half in rows, in double or lanes: makes a
/// gradient exact for linear fields. Where it has nearly no inverse (too few neighbors, or all in a plane),
/// `fits` is false. The determinant is 1 in the bulk, about 1/2 on a face, 1/4 on an edge.
template <int Dim, class T>
struct InverseMoment {
  T entry[Dim][Dim];
  decltype(T() > T()) fits;

  explicit InverseMoment(const T (&m)[Dim * (Dim + 1) / 2]) {
    T determinant;
    if constexpr (Dim == 2) {
      entry[0][0] = m[2];
      entry[1][1] = m[0];
      entry[0][1] = entry[1][0] = -m[1];
      determinant = m[0] * m[2] - m[1] * m[1];
    } else {
      // Upper half by rows: xx, xy, xz, yy, yz, zz.
      entry[0][0] = m[3] * m[5] - m[4] * m[4];
      entry[0][1] = entry[1][0] = m[2] * m[4] - m[1] * m[5];
      entry[0][2] = entry[2][0] = m[1] * m[4] - m[2] * m[3];
      entry[1][1] = m[0] * m[5] - m[2] * m[2];
      entry[1][2] = entry[2][1] = m[1] * m[2] - m[0] * m[4];
      entry[2][2] = m[0] * m[3] - m[1] * m[1];
      determinant = m[0] * entry[0][0] + m[1] * entry[0][1] + m[2] * entry[0][2];
    }
    constexpr double least = 0.1;
    fits = determinant > T(least);
    const T inverse = T(1) / max(T(least), determinant);
    for (auto& row : entry)
      for (T& e : row) e *= inverse;
  }
};

/// Writes all records of a soil particle but the position from the fields, as predict and observation do.
template <int Dim>
class SoilPacking {
 public:
  SoilPacking(const World<Dim>& world, const ParticleSet<Dim>& soil)
      : parts_(world), volume_(soil.scalar(fields::volume)), fraction_(soil.scalar(fields::volume_fraction)),
        velocity_(soil.vector(fields::velocity)), stress_(soil.tensor(fields::stress)), strain_rate_(soil.tensor(fields::strain_rate)), part_(soil.tag(fields::part)) {}

  template <class T>
  void operator()(Records<Dim, T>& first, Records<Dim, T>& second, Records<Dim, T>& third, Index i) const {
    T* slot = first[i];
    slot[soil_slot::volume] = static_cast<T>(volume_[i]);
    slot[soil_slot::volume_fraction] = static_cast<T>(fraction_[i]);
    for (int k = 0; k < Dim; ++k) slot[soil_slot::velocity + k] = static_cast<T>(velocity_[i][k]);
    T* two = second[i];
    pack_stress<Dim>(stress_[i], two);
    pack_stress<Dim>(strain_rate_[i], third[i]);
    two[soil_slot::density - record_size] = static_cast<T>(parts_[part_[i]].density);
    two[soil_slot::impedance - record_size] = static_cast<T>(parts_[part_[i]].impedance());
  }

 private:
  SoilParts parts_;
  const Field<double>& volume_;
  const Field<double>& fraction_;
  const Field<Vec<Dim>>& velocity_;
  const Field<Sym3>& stress_;
  const Field<Sym3>& strain_rate_;
  const Field<std::int32_t>& part_;
};

}  // namespace sphgeo
