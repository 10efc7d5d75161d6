#pragma once
// What the effects of the soil phase share: record layout, the Riemann
// flux.

#include <algorithm>
#include <cmath>
#include <vector>

#include "effects/lattice_sums.h"
#include "effects/water_phase.h"
#include "materials/drucker_prager.h"
#include "sph/gather.h"
#include "sph/kernel.h"
#include "sph/parameters.h"
#include "sph/world.h"

namespace sphgeo {

/// The stress point of a soil.
inline DruckerPrager<double> stress_point(const StressPointParameters& m) {
  return {m.bulk, m.shear, m.friction, m.dilation, m.strength, m.apex};
}

/// The kernel of the soil. Its gradient is divided by the lattice moment, 0.974 in 2D and 0.979 in
/// 3D for h = 1.3 dp: that is how much too weak a gradient the bare sums see, and by which the
/// stress at rest would exceed the weight at any resolution. The factor is one number for all
/// pairs, so momentum stays exact.
template <int Dim>
Kernel<Dim> soil_kernel(const ParticleSet<Dim>& soil) {
  Kernel<Dim> kernel(soil.smoothing_length());
  kernel.slope /= lattice_sums(kernel, soil.spacing()).moment;
  return kernel;
}

/// Slots of a soil record behind the position. Volume and velocity sit where the water has them.
/// Passes over soil of one kind read two records; the third (in 2D the second) holds what else
/// unlike soils and walls need.
namespace soil_slot {
inline constexpr int volume = 3;    ///< V
inline constexpr int velocity = 4;  ///< v, Dim numbers
inline constexpr int scratch = 7;   ///< of the reinitialization, between two packings
/// Number k of sigma . B by rows, Dim x Dim numbers: in 3D the last one takes the place that
/// velocity leaves.
template <int Dim>
constexpr int stress(int k) {
  return k < 8 ? 8 + k : 7;
}
template <int Dim>
inline constexpr int pressure =
    Dim == 2 ? 12 : 16;  ///< P' = -tr(sigma)/3 of Eq. 51, three-dimensional also in plane strain
template <int Dim>
inline constexpr int density = pressure<Dim> + 1;  ///< rho_0 of the part
template <int Dim>
inline constexpr int impedance = pressure<Dim> + 2;  ///< rho_0 c_0 of the part
template <int Dim>
inline constexpr int friction =
    pressure<Dim> + 3;  ///< mu = tan phi of the part, between soil and rough walls
template <int Dim>
inline constexpr int borne =
    Dim == 2 ? 6
             : 20;  ///< share of its weight that the skeleton bears itself: less than 1 in water
}  // namespace soil_slot

/// Number of records of a soil particle with all that is in them.
template <int Dim>
inline constexpr int soil_records = Dim == 2 ? 2 : 3;

/// Number of records that this scene needs.
template <int Dim>
int soil_records_used(const World<Dim>& world) {
  return world.parameters().soil.uniform && !world.find("walls") && !world.find("skin")
             ? 2
             : soil_records<Dim>;
}

/// What a pass sees of a soil particle with all its records.
template <int Dim, class T>
using SoilRecord = Record<Dim, T, soil_records<Dim>>;

/// The record arrays of the soil: N of them.
template <class T, int N, int Dim>
auto stress_records(World<Dim>& world) {
  const auto& first = world.records("soil", 0).template get<T>();
  const auto& second = world.records("soil", 1).template get<T>();
  if constexpr (N == 2) return with(first, second);
  else return with(first, second, world.records("soil", 2).template get<T>());
}

/// sigma . B of a record.
template <int Dim, class T, int N>
void unpack_stress(const Record<Dim, T, N>& record, T (&a)[Dim * Dim]) {
  for (int k = 0; k < Dim * Dim; ++k) a[k] = record[soil_slot::stress<Dim>(k)];
}

/// a . r of a tensor whose numbers stand by rows.
template <class T, int Dim>
LaneVec<Dim, T> times(const T (&a)[Dim * Dim], const LaneVec<Dim, T>& r) {
  LaneVec<Dim, T> f;
  for (int k = 0; k < Dim; ++k) {
    f[k] = a[k * Dim] * r[0];
    for (int l = 1; l < Dim; ++l) f[k] += a[k * Dim + l] * r[l];
  }
  return f;
}

/// Axes of the x-z plane, or of space, in the order of a Sym3.
template <int Dim>
inline constexpr int tensor_index[Dim][Dim] = {};
template <>
inline constexpr int tensor_index<2>[2][2] = {{0, 5}, {5, 2}};
template <>
inline constexpr int tensor_index<3>[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/// Inverse of a moment sum(r (x) grad W V) given by its upper half in rows, in double or lanes:
/// makes a gradient exact for linear fields; the identity where it has nearly no inverse (too few
/// neighbors, or all in a plane). The determinant is 1 in the bulk, about 1/2 on a face, 1/4 on an
/// edge.
template <int Dim, class T>
struct InverseMoment {
  T entry[Dim][Dim];

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
    T mean = m[0] + m[2];
    if constexpr (Dim == 3) mean = m[0] + m[3] + m[5];
    mean *= T(1.0 / Dim);
    // How far the neighbors are from lying in a plane, whatever their number: at least 0.1, and 1
    // in the bulk.
    const T scale = Dim == 2 ? mean * mean : mean * mean * mean;
    const T inverse = T(1) / max(T(1e-6), determinant);
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) {
        const T one = T(k == l);
        entry[k][l] = select(mean > T(0.1),
                             select(determinant > T(0.1) * scale, entry[k][l] * inverse, one), one);
      }
  }
  void reset() {
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) entry[k][l] = T(k == l);
  }
};

/// Writes all records of a soil particle but the position from the fields, as predict and
/// observation do.
template <int Dim, class T>
class SoilPacking {
 public:
  SoilPacking(World<Dim>& world, const ParticleSet<Dim>& soil)
      : count_(soil_records_used(world)),
        parts_(world.parameters().soil),
        volume_(soil.scalar(fields::volume)),
        velocity_(soil.vector(fields::velocity)),
        stress_(soil.tensor(fields::stress)),
        correction_(soil.tensor(fields::gradient_correction)),
        part_(soil.tag(fields::part)),
        by_water_(soil.has(fields::water_acceleration) ? &soil.vector(fields::water_acceleration)
                                                       : nullptr),
        gravity_(world.gravity()) {
    for (int k = 0; k < count_; ++k) records_[k] = &world.records("soil", k).template get<T>();
  }

  void operator()(Index i) const {
    namespace slot = soil_slot;
    T* one = (*records_[0])[i];
    one[slot::volume] = static_cast<T>(volume_[i]);
    for (int k = 0; k < Dim; ++k) one[slot::velocity + k] = static_cast<T>(velocity_[i][k]);

    const Sym3 &s = stress_[i], &b = correction_[i];
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) {
        double sum = 0;
        for (int m = 0; m < Dim; ++m)
          sum += s[tensor_index<Dim>[k][m]] * b[tensor_index<Dim>[m][l]];
        put(i, slot::stress<Dim>(k * Dim + l), sum);
      }
    if (count_ * record_size <= slot::pressure<Dim>) return;
    const SoilPart& part = parts_[part_[i]];
    put(i, slot::pressure<Dim>, -(s[0] + s[1] + s[2]) / 3);
    put(i, slot::density<Dim>, part.density);
    double borne = 1;
    if (by_water_)
      borne = std::clamp(
          1 + (*by_water_)[i].dot(gravity_) / std::max(gravity_.squaredNorm(), 1e-30), 0.0, 1.0);
    put(i, slot::borne<Dim>, borne);
    put(i, slot::impedance<Dim>, part.impedance());
    put(i, slot::friction<Dim>, part.friction);
  }

 private:
  void put(Index i, int slot, double value) const {
    (*records_[slot / record_size])[i][slot % record_size] = static_cast<T>(value);
  }

  int count_;
  Records<Dim, T>* records_[soil_records<Dim>] = {};
  const SoilParameters& parts_;
  const Field<double>& volume_;
  const Field<Vec<Dim>>& velocity_;
  const Field<Sym3>& stress_;
  const Field<Sym3>& correction_;
  const Field<std::int32_t>& part_;
  const Field<Vec<Dim>>* by_water_;  // null: there is no water
  Vec<Dim> gravity_;
};

}  // namespace sphgeo
