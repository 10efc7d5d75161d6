#pragma once
// What the effects of solids share: parameters of their bodies, needs, the deformation of
// the current positions.

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/soil_phase.h"
#include "effects/solid_packing.h"
#include "materials/hyperelastic.h"
#include "sph/gather.h"
#include "sph/kernel.h"

namespace sphgeo {

/// CFL number of elastic solids (Eq. 94). With the quadratic gradient, weights of one side only, at
/// corners, see short waves twice as well.
inline double solid_courant(const NumericsParameters& n) {
  return (n.solid_gradient == SolidGradient::quadratic ? 0.7 : 1.0) * n.cfl_solid;
}

/// The law of an elastic solid.
inline Hyperelastic law_of(const SolidPart& part) {
  return {part.shear, part.lame, part.neo_hookean};
}

/// Whether what is clamped bears no strain: the quadratic gradient has the clamp's face in the free
/// particles.
template <int Dim>
bool clamps_at_face(const World<Dim>& world) {
  return world.parameters().numerics.solid_gradient == SolidGradient::quadratic;
}

/// Whether a set has solids with an artificial viscosity.
template <int Dim>
bool viscous_solids(const World<Dim>& world, const std::string& set) {
  const SolidParameters& parts = world.parameters().solids;
  for (std::size_t b = 0; b < parts.of.size(); ++b)
    if (parts.of[b].viscosity > 0 && parts.of[b].set == set) return true;
  return false;
}

/// Names of the sets of solids in a world.
template <int Dim>
std::vector<std::string> solid_sets(const World<Dim>& world) {
  std::vector<std::string> names;
  for (const auto& set : world.sets())
    if (set->phase() == "solid") names.push_back(set->name());
  return names;
}

/// One effect of kind E for each set of solids that has elastic bodies (or `rigid` ones). E is made
/// from the name of the set, and from whether its solids are viscous where it asks for that.
template <class E, int Dim>
Binding<Dim> bind_solids(const World<Dim>& world, bool rigid = false) {
  Binding<Dim> binding(rigid ? "there are no rigid solids" : "there are no elastic solids");
  for (const SolidPart& part : world.parameters().solids.of) {
    if (!part.is_solid || part.rigid() != rigid || !world.find(part.set)) continue;
    const std::string& set = part.set;
    const auto same = [&](const auto& e) { return static_cast<const E&>(*e).set_name() == set; };
    if (std::any_of(binding.effects.begin(), binding.effects.end(), same)) continue;
    if constexpr (std::is_constructible_v<E, std::string, bool>)
      binding.effects.push_back(std::make_unique<E>(set, viscous_solids(world, set)));
    else binding.effects.push_back(std::make_unique<E>(set));
    binding.because = rigid ? "there are rigid solids" : "there are elastic solids";
  }
  return binding;
}

/// Names what a set of solids needs for Deformation: the positions at rest, and a displacement of
/// the effect's own.
template <int Dim>
void need_deformation(Needs& needs, const std::string& set) {
  using Displacement = packed::Displacement<Dim>;
  needs.record<Displacement>(set, Access::read, Displacement::position);
  needs.record<Displacement>(set, Access::scratch, Displacement::displacement);
}

/// Names the records of their stress, or all that is written of them by `access`.
template <int Dim>
void need_piola(Needs& needs, const std::string& set, Access access) {
  needs.record<packed::Piola<Dim>>(set, access, packed::Piola<Dim>::numbers);
  if constexpr (Dim == 3) needs.record<packed::PiolaRest>(set, access);
}

/// A plain matrix of the scene's dimension.
template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;

/// A tensor of the scene in three dimensions; in 2D zero across the plane.
template <int Dim>
Mat3 to_space_tensor(const Mat<Dim>& m) {
  if constexpr (Dim == 3) return m;
  Mat3 t = Mat3::Zero();
  for (int k = 0; k < 2; ++k)
    for (int l = 0; l < 2; ++l) t(2 * k, 2 * l) = m(k, l);
  return t;
}
template <int Dim>
Mat<Dim> to_scene_tensor(const Mat3& t) {
  if constexpr (Dim == 3) return t;
  Mat<Dim> m;
  for (int k = 0; k < 2; ++k)
    for (int l = 0; l < 2; ++l) m(k, l) = t(2 * k, 2 * l);
  return m;
}
template <int Dim>
Mat<Dim> to_matrix(const Sym3& s) {
  Mat<Dim> m;
  for (int k = 0; k < Dim; ++k)
    for (int l = 0; l < Dim; ++l) m(k, l) = s[tensor_index<Dim>[k][l]];
  return m;
}

/// A rigid motion close to that of a body: x = center + rotation (X - reference_center).
template <int Dim>
struct BodyFrame {
  Mat<Dim> rotation = Mat<Dim>::Identity();
  Vec<Dim> center = Vec<Dim>::Zero(), reference_center = Vec<Dim>::Zero();
};

/// The rotation nearest to a matrix.
template <int Dim>
Mat<Dim> nearest_rotation(const Mat<Dim>& a) {
  const Eigen::JacobiSVD<Mat<Dim>> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat<Dim> flip = Mat<Dim>::Identity();
  flip(Dim - 1, Dim - 1) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * flip * svd.matrixV().transpose();
}

/// The deformation gradient of all particles of a set at their positions. Eq. 67 is linear in the
/// velocities, and so is its integral in the positions: with B0, F_i = sum_j (x_j - x_i) (x) grad W
/// V B0, and no error adds up. The pair sums see w = R^T (x - c) - (X - C), what a body has moved
/// beyond its rigid motion (R, c): as F = R (I + sum (w_j - w_i) (x) grad W V B0) holds for any R
/// and c, single precision costs digits of the strain and not of the displacement.
template <int Dim>
class Deformation {
 public:
  explicit Deformation(std::string set) : set_(std::move(set)) {}

  /// Frames of the bodies in the current configuration, from a few particles of each: an estimate
  /// suffices.
  void find_frames(const World<Dim>& world);
  const BodyFrame<Dim>& frame(std::int32_t part) const {
    return frames_[static_cast<std::size_t>(part)];
  }

  /// Writes w of particle i at the position x.
  template <class T>
  void pack(const RecordPacking<packed::Displacement<Dim>, T>& records, Index i, const Vec<Dim>& x,
            const Vec<Dim>& reference, std::int32_t part) const {
    const BodyFrame<Dim>& f = frame(part);
    const Vec<Dim> w = f.rotation.transpose() * (x - f.center) - (reference - f.reference_center);
    records[i].put(packed::Displacement<Dim>::displacement, w);
  }

  /// Calls finish(i, g): F = R (I + g) with the rotation of the body's frame. Reads what pack()
  /// wrote.
  template <class F>
  void gather_gradients(World<Dim>& world, F&& finish) const;

 private:
  std::string set_;
  std::vector<BodyFrame<Dim>> frames_;
};

/// Sum of (w_j - w_i) (x) grad W at rest.
template <int Dim>
struct DisplacementGradient {
  using Solid = packed::Displacement<Dim>;
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T g[Dim * Dim] = {};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Solid>& i, const Record<T, Solid>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T gradient = kernel.dw_over_r(r2);
    const LaneVec<Dim, T> dw = gradient * (j.vec(Solid::displacement) - i.vec(Solid::displacement));
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) sum.g[k * Dim + l] += dw[k] * r[l];
  }
};

template <int Dim>
template <class F>
void Deformation<Dim>::gather_gradients(World<Dim>& world, F&& finish) const {
  const ParticleSet<Dim>& set = world.set(set_);
  const auto& volume = set.scalar(fields::reference_volume);
  const auto& correction = set.tensor(fields::reference_correction);
  const auto& x = set.vector(fields::position);
  const auto& reference = set.vector(fields::reference_position);
  const auto& part = set.tag(fields::part);
  const DisplacementGradient<Dim> pair{Kernel<Dim>(set.smoothing_length())};
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    using Solid = packed::Displacement<Dim>;
    const auto records = read_records<Solid, T>(world, set_);
    const PairWeights<Dim>& more = world.reference_weights(set_);
    gather<DisplacementGradient<Dim>::template Sums>(
        world.reference_list(set_), records, records, pair, [&](Index i, const auto& sum) {
          Mat<Dim> g;
          for (int k = 0; k < Dim * Dim; ++k) g(k / Dim, k % Dim) = sum.g[k];
          g = (volume[i] * g * to_matrix<Dim>(correction[i]))
                  .eval();  // one volume for all pairs of a body
          if (!more.empty())
            more.by_target.for_row(i, [&](Index j, const float* weight) {
              // A weight on itself stands for a clamp near by: see quadratic_weights().
              Vec<Dim> mirrored = Vec<Dim>::Zero();
              if (j == i) mirrored = frame(part[i]).rotation.transpose() * (reference[i] - x[i]);
              for (int k = 0; k < Dim; ++k) {
                const double dw = j == i ? mirrored[k]
                                         : records.get(j, Solid::displacement, k) -
                                               records.get(i, Solid::displacement, k);
                for (int l = 0; l < Dim; ++l) g(k, l) += dw * static_cast<double>(weight[l]);
              }
            });
          finish(i, g);
        });
  });
}

template <int Dim>
void Deformation<Dim>::find_frames(const World<Dim>& world) {
  constexpr Index samples = 64;
  const ParticleSet<Dim>& set = world.set(set_);
  const auto& x = set.vector(fields::position);
  const auto& reference = set.vector(fields::reference_position);
  const auto& part = set.tag(fields::part);
  const std::size_t bodies = world.parameters().solids.of.size();
  frames_.assign(bodies, {});
  // An odd stride: on a lattice, an even one may see one plane only.
  const Index stride = std::max<Index>(1, set.size() / (samples * static_cast<Index>(bodies))) | 1;
  std::vector<double> count(bodies, 0);
  for (Index i = 0; i < set.size(); i += stride) {
    BodyFrame<Dim>& f = frames_[static_cast<std::size_t>(part[i])];
    f.center += x[i];
    f.reference_center += reference[i];
    count[static_cast<std::size_t>(part[i])] += 1;
  }
  std::vector<Mat<Dim>> moment(bodies, Mat<Dim>::Zero());
  for (std::size_t b = 0; b < bodies; ++b)
    if (count[b] > 0) {
      frames_[b].center /= count[b];
      frames_[b].reference_center /= count[b];
    }
  for (Index i = 0; i < set.size(); i += stride) {
    const auto b = static_cast<std::size_t>(part[i]);
    moment[b] +=
        (x[i] - frames_[b].center) * (reference[i] - frames_[b].reference_center).transpose();
  }
  for (std::size_t b = 0; b < bodies; ++b)
    if (count[b] > Dim && moment[b].allFinite())
      frames_[b].rotation = nearest_rotation<Dim>(moment[b]);
}

}  // namespace sphgeo
