#pragma once
// Vectors and tensors that every room shares. Constitutive code and shapes see three components;
// the particle rooms are templates over the dimension. A two-dimensional scene is the x-z plane:
// z is up in both, and Vec<2> holds (x, z).

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace sphgeo {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A point or vector of a Dim-dimensional scene: (x, z) in 2D, (x, y, z) in 3D.
template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;

using Index = std::int64_t;
using Id = std::uint64_t;

/// Drops y in 2D.
template <int Dim>
Vec<Dim> to_scene(const Vec3& a) {
  if constexpr (Dim == 2) return {a.x(), a.z()};
  else return a;
}

/// Puts a scene vector into space; y = 0 in 2D.
template <int Dim>
Vec3 to_space(const Vec<Dim>& a) {
  if constexpr (Dim == 2) return {a[0], 0.0, a[1]};
  else return a;
}

/// Axis-aligned box, SI metres. Components may be infinite.
struct Aabb {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec3& p) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  void extend(const Aabb& b) {
    lo = lo.cwiseMin(b.lo);
    hi = hi.cwiseMax(b.hi);
  }
  Aabb grown(double by) const { return {lo.array() - by, hi.array() + by}; }
  bool contains(const Vec3& p) const {
    return (p.array() >= lo.array()).all() && (p.array() <= hi.array()).all();
  }
  bool empty() const { return (lo.array() > hi.array()).any(); }
};

}  // namespace sphgeo
