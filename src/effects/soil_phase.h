#pragma once
// What the effects of the soil phase share: parameters of its parts, their packing, the moment of
// gradients.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "effects/lattice_sums.h"
#include "effects/soil_packing.h"
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

/// Whether passes read the parameters of single particles: there are unlike soils, or walls.
template <int Dim>
bool soil_parameters_used(const World<Dim>& world) {
  return !world.parameters().soil.uniform || world.find("walls") || world.find("interface");
}

/// What a pass sees of a soil particle with all its records, and of one among its like.
template <int Dim, class T>
using SoilRecord = std::conditional_t<
    Dim == 2, Record<T, packed::SoilState<Dim>, packed::SoilStress<Dim>>,
    Record<T, packed::SoilState<Dim>, packed::SoilStress<Dim>, packed::SoilMaterial>>;
template <int Dim, class T>
using UniformSoilRecord = Record<T, packed::SoilState<Dim>, packed::SoilStress<Dim>>;

/// The records of the soil, all or what passes over soil of one kind read.
template <class T, bool All, int Dim>
auto soil_records(World<Dim>& world) {
  const auto first = read_records<packed::SoilState<Dim>, T>(world, "soil");
  const auto second = read_records<packed::SoilStress<Dim>, T>(world, "soil");
  if constexpr (Dim == 2 || !All) return with(first, second);
  else return with(first, second, read_records<packed::SoilMaterial, T>(world, "soil"));
}

/// Names them.
template <int Dim>
void need_soil_records(Needs& needs, Access access, bool all) {
  needs.record<packed::SoilState<Dim>>("soil", access);
  needs.record<packed::SoilStress<Dim>>("soil", access);
  if (Dim == 3 && all) needs.record<packed::SoilMaterial>("soil", access);
}

/// sigma . B of a record.
template <int Dim, class T, class... R>
void unpack_stress(const Record<T, R...>& record, T (&a)[Dim * Dim]) {
  using Stress = packed::SoilStress<Dim>;
  for (int k = 0; k < Stress::stress.count; ++k) a[k] = record.at(Stress::stress, k);
  if constexpr (Dim == 3) a[8] = record[packed::SoilState<3>::stress_zz];
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

/// Names what SoilPacking needs beside the fields of the state, and what it writes.
template <int Dim>
void need_soil_packing(Needs& needs, bool parameters) {
  needs.fields.push_back({"soil", &fields::water_acceleration, Access::previous, true});
  need_soil_records<Dim>(needs, Access::write, parameters);
}

/// Writes all records of a soil particle but the position from the fields.
template <int Dim, class T>
class SoilPacking {
 public:
  SoilPacking(World<Dim>& world, const ParticleSet<Dim>& soil)
      : records_(write_records<Soil, T>(world, "soil")),
        stresses_(write_records<Stress, T>(world, "soil")),
        parts_(world.parameters().soil),
        volume_(soil.scalar(fields::volume)),
        velocity_(soil.vector(fields::velocity)),
        stress_(soil.tensor(fields::stress)),
        correction_(soil.tensor(fields::gradient_correction)),
        part_(soil.tag(fields::part)),
        by_water_(soil.has(fields::water_acceleration) ? &soil.vector(fields::water_acceleration)
                                                       : nullptr),
        gravity_(world.gravity()) {
    if constexpr (Dim == 3)
      if (soil_parameters_used(world))
        parameters_ = write_records<packed::SoilMaterial, T>(world, "soil");
  }

  void operator()(Index i) const {
    const auto record = records_[i];
    const auto stress = stresses_[i];
    record.put(Soil::volume, volume_[i]);
    record.put(Soil::velocity, velocity_[i]);
    const Sym3 &s = stress_[i], &b = correction_[i];
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) {
        double sum = 0;
        for (int m = 0; m < Dim; ++m)
          sum += s[tensor_index<Dim>[k][m]] * b[tensor_index<Dim>[m][l]];
        const int number = k * Dim + l;
        if (number < Stress::stress.count) stress.put(Stress::stress, number, sum);
        else if constexpr (Dim == 3) record.put(Soil::stress_zz, sum);
      }
    if constexpr (Dim == 2) {
      put_parameters(stress, i);
      record.put(Soil::borne, borne(i));
    } else if (parameters_) {
      const auto parameters = (*parameters_)[i];
      put_parameters(parameters, i);
      parameters.put(packed::SoilMaterial::borne, borne(i));
    }
  }

 private:
  using Soil = packed::SoilState<Dim>;
  using Stress = packed::SoilStress<Dim>;

  template <class R>
  void put_parameters(const PackedRecord<R, T>& record, Index i) const {
    const SoilPart& part = parts_[part_[i]];
    const Sym3& s = stress_[i];
    record.put(R::pressure, -(s[0] + s[1] + s[2]) / 3);
    record.put(R::density, part.density);
    record.put(R::impedance, part.impedance());
    record.put(R::friction, part.friction);
  }
  double borne(Index i) const {
    if (!by_water_) return 1;
    return std::clamp(1 + (*by_water_)[i].dot(gravity_) / std::max(gravity_.squaredNorm(), 1e-30),
                      0.0, 1.0);
  }

  RecordPacking<Soil, T> records_;
  RecordPacking<Stress, T> stresses_;
  std::optional<RecordPacking<packed::SoilMaterial, T>> parameters_;  // where they are used, in 3D
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
