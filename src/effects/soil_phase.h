#pragma once
// What the effects of the soil phase share: parameters of its parts, record layout, the Riemann
// flux.

#include <algorithm>
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
  bool moves = false;              ///< by forces
  bool fixed = false;              ///< never moves
  double grain_density = 0;        ///< rho^s
  double density = 0;      ///< rho_0 of the skeleton: rho^s times its mean volume fraction at t = 0
  double sound_speed = 0;  ///< c_0 of Eq. 53
  double friction = 0;     ///< tan phi
  DruckerPrager<double> constants{};  ///< of the stress point, dry
  double wet_strength = 0;            ///< k_c at full saturation
  double impedance() const { return density * sound_speed; }
};

/// Parameters of all parts, by index of the body.
struct SoilParts {
  std::vector<SoilPart> of;
  bool uniform = true;  ///< all soil is of one impedance and density: the pair flux needs no table
  bool deformable = false;  ///< some soil moves by forces
  SoilPart first;           ///< of the first body of soil
  double fastest = 0;       ///< largest speed of sound of soil that moves by forces
  double fastest_wave = 0;  ///< of compression waves: sqrt((K + 4 G / 3) / rho_0)

  template <int Dim>
  explicit SoilParts(const World<Dim>& world) {
    const ParticleSet<Dim>& soil = world.set("soil");
    for (std::size_t b = 0; b < world.model().bodies.size(); ++b) {
      SoilPart part;
      part.material =
          dynamic_cast<const Soil*>(world.model().material(world.model().bodies[b].material));
      if (part.material) {
        part.moves = part.material->moves_by_forces();
        part.fixed = part.material->skeleton == "fixed";
        part.grain_density = part.material->density;
        part.density = soil.constant("density." + std::to_string(b));
        part.sound_speed = std::sqrt(part.material->bulk_modulus() / part.density);
        part.friction = part.material->elastic() ? 0 : part.material->tan_friction();
        part.constants = part.material->constants();
        part.wet_strength = part.material->constants(1.0).strength;
        if (!first.material) first = part;
        uniform = uniform && part.density == first.density && part.sound_speed == first.sound_speed;
        deformable = deformable || part.moves;
        if (part.moves) {
          fastest = std::max(fastest, part.sound_speed);
          fastest_wave =
              std::max(fastest_wave, std::sqrt(part.material->oedometric_modulus() / part.density));
        }
      }
      of.push_back(part);
    }
  }
  const SoilPart& operator[](std::int32_t part) const { return of[static_cast<std::size_t>(part)]; }
};

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

/// xi^s of Eq. 54.
template <int Dim>
double soil_limiter(const World<Dim>& world) {
  return world.model().numerics.limiter_soil.value_or(20.0 * Dim);
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
  return SoilParts(world).uniform && !world.find("walls") && !world.find("skin")
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
        parts_(world),
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
  SoilParts parts_;
  const Field<double>& volume_;
  const Field<Vec<Dim>>& velocity_;
  const Field<Sym3>& stress_;
  const Field<Sym3>& correction_;
  const Field<std::int32_t>& part_;
  const Field<Vec<Dim>>* by_water_;  // null: there is no water
  Vec<Dim> gravity_;
};

}  // namespace sphgeo
