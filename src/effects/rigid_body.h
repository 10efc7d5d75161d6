#pragma once
// Rigid solids: their motion is in their particles, and nowhere else.

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/indices_where.h"
#include "effects/solid_phase.h"

namespace sphgeo {

/// Motion of one rigid body, read off its particles; vectors have y = 0 in 2D, turns are about y
/// there.
struct RigidMotion {
  double mass = 0;               ///< kg
  Vec3 center = Vec3::Zero();    ///< of mass, m
  Vec3 velocity = Vec3::Zero();  ///< of the centre, m/s
  Vec3 spin = Vec3::Zero();      ///< angular momentum about the centre, kg m2/s
  Mat3 inertia = Mat3::Zero();   ///< about the centre, kg m2

  /// Angular velocity, rad/s.
  Vec3 turning(int dimension) const {
    if (dimension == 2)
      return inertia(1, 1) > 0 ? Vec3(0, spin.y() / inertia(1, 1), 0) : Vec3::Zero();
    // A row of particles does not resist turning about itself: that axis is left out.
    Eigen::SelfAdjointEigenSolver<Mat3> axes;
    axes.computeDirect(inertia);
    Vec3 turn = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      if (axes.eigenvalues()[k] > 1e-9 * axes.eigenvalues()[2])
        turn += axes.eigenvectors().col(k).dot(spin) / axes.eigenvalues()[k] *
                axes.eigenvectors().col(k);
    return turn;
  }
};

/// The particles of every rigid body of one set.
template <int Dim>
class RigidBodies {
 public:
  explicit RigidBodies(std::string set) : set_(std::move(set)) {}
  const std::string& set_name() const { return set_; }

  /// Finds them, once: solids keep their order.
  void find(const World<Dim>& world);
  std::size_t size() const { return bodies_.size(); }
  const std::vector<std::uint32_t>& particles(std::size_t body) const { return bodies_[body]; }
  std::size_t bytes() const;

  RigidMotion motion(const World<Dim>& world, std::size_t body) const;

  /// Moves the particles of a body for a time with its velocity and turning. Its angular momentum
  /// stays, and its velocities become what that means at the new positions.
  static void advance(ParticleSet<Dim>& set, const std::vector<std::uint32_t>& particles,
                      RigidMotion m, double time);

 private:
  std::string set_;
  std::vector<std::vector<std::uint32_t>> bodies_;
};

template <int Dim>
void RigidBodies<Dim>::find(const World<Dim>& world) {
  if (!bodies_.empty()) return;
  const ParticleSet<Dim>& set = world.set(set_);
  const auto& part = set.tag(fields::part);
  const SolidParameters& parts = world.parameters().solids;
  std::vector<std::vector<std::uint32_t>> all(parts.of.size());
  for (const std::uint32_t i :
       indices_where(set.size(), [&](Index k) { return !parts[part[k]].elastic; }))
    all[static_cast<std::size_t>(part[i])].push_back(i);
  for (auto& body : all)
    if (!body.empty()) bodies_.push_back(std::move(body));
}

template <int Dim>
std::size_t RigidBodies<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& b : bodies_) sum += b.capacity() * sizeof(std::uint32_t);
  return sum;
}

template <int Dim>
RigidMotion RigidBodies<Dim>::motion(const World<Dim>& world, std::size_t body) const {
  const ParticleSet<Dim>& set = world.set(set_);
  const auto& x = set.vector(fields::position);
  const auto& v = set.vector(fields::velocity);
  const auto& m = set.scalar(fields::mass);
  RigidMotion r;
  for (const Index i : bodies_[body]) {
    r.mass += m[i];
    r.center += m[i] * to_space<Dim>(x[i]);
    r.velocity += m[i] * to_space<Dim>(v[i]);
  }
  r.center /= r.mass;
  r.velocity /= r.mass;
  for (const Index i : bodies_[body]) {
    const Vec3 d = to_space<Dim>(x[i]) - r.center;
    r.spin += m[i] * d.cross(to_space<Dim>(v[i]) - r.velocity);
    r.inertia += m[i] * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  return r;
}

template <int Dim>
void RigidBodies<Dim>::advance(ParticleSet<Dim>& set, const std::vector<std::uint32_t>& particles,
                               RigidMotion m, double time) {
  auto& x = set.vector(fields::position);
  auto& v = set.vector(fields::velocity);
  Vec3 turning = m.turning(Dim);
  const double angle = turning.norm() * time;
  const Mat3 turn = angle > 0 ? Eigen::AngleAxisd(angle, turning.normalized()).toRotationMatrix()
                              : Mat3::Identity();
  m.inertia = turn * m.inertia * turn.transpose();
  turning = m.turning(Dim);
  // In all threads where there is one body; in that of the body where there are several.
  parallel_for(static_cast<Index>(particles.size()), [&](Index k) {
    const Index i = particles[static_cast<std::size_t>(k)];
    const Vec3 d = turn * (to_space<Dim>(x[i]) - m.center);
    x[i] = to_scene<Dim>(m.center + d + time * m.velocity);
    v[i] = to_scene<Dim>(m.velocity + turning.cross(d));
  });
}

}  // namespace sphgeo
