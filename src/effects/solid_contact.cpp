#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "effects/interface.h"
#include "effects/meeting_bodies.h"
#include "effects/wall_touch.h"
#include "sph/cell_grid.h"
#include "sph/neighbor_list.h"

namespace sphgeo {
namespace {

/// What a contact of two solids needs of a interface particle.
template <int Dim>
struct ContactPoint {
  Vec<Dim> x = Vec<Dim>::Zero(), v = Vec<Dim>::Zero();
  double volume = 0;
  double mass = 0;
  double stiffness = 0;  ///< rho_0 c_0^2
  double impedance = 0;  ///< rho_0 c_0 times contact_damping
  double friction = 0;
  double reach = 0;  ///< of the contact with other solids, 2 h^c, m
};

/// Contact of solids with each other, with walls, and of a body with itself (Eqs. 78, 79).
///
/// The pressure of a contact is rho_0 c_0^2 sum W V over the particles of others in reach, and the
/// forces are the gradient of an energy, 1/2 rho_0 c_0^2 V (sum W V)^2 for every particle: a
/// contact without friction and damping gives back what it took. Bodies that start closer than 2
/// h^c would be pushed apart by their mere presence: for them the reach is the gap of their
/// particles at rest, so that they touch without force.
///
/// Walls mirror the pressure of the solid, but only of what the sum exceeds the one of a plane wall
/// that is touched: surface on surface, or as close as the body starts. A reach as short as the gap
/// would see the single particles of the wall, and a block on a slope would rattle from one to the
/// next. The force follows the gradient of the sum, which a plane has along its normal.
template <int Dim>
class SolidContact final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {
        "solid_contact", Stage::solid_force,
        "Eqs. 78, 79",   "contact of solids with each other and with walls",
        false,           "solids pass through each other, through themselves and through walls"};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface")) return {"no solid can meet anything"};
    std::size_t solids = 0;
    bool folds = false;
    for (const SolidPart& p : world.parameters().solids.of)
      if (p.is_solid) {
        ++solids;
        folds = folds || p.self_contact;
      }
    if (solids < 2 && !folds && !world.find("walls"))
      return {"there is one solid, no wall, and it does not fold"};
    return {std::make_unique<SolidContact>(world),
            world.find("walls") ? "there are solids and walls" : "solids can meet each other"};
  }

  explicit SolidContact(const World<Dim>& world)
      : solids_(solid_sets(world)), walls_(world.find("walls") != nullptr) {}

  std::string acts_on() const override { return "interface"; }
  Needs needs() const override {
    Needs n{{{"interface", &fields::position, Access::read},
             {"interface", &fields::contact_force, Access::write},
             {"interface", &fields::contact_energy, Access::write}},
            {}};
    for (const std::string& set : solids_) {
      n.fields.push_back({set, &fields::acceleration_sum, Access::add});
      n.fields.push_back({set, &fields::reference_position, Access::read});
    }
    if (walls_) n.lists.push_back({"interface", "walls"});
    return n;
  }

  void apply(World<Dim>& world) override {
    if (arrangement_ != world.arrangement()) find_partners(world);
    auto& f = world.set("interface").vector(fields::contact_force);
    auto& energy = world.set("interface").scalar(fields::contact_energy);
    parallel_for(f.size(), [&](Index k) {
      f[k].setZero();
      energy[k] = 0;
    });
    if (!near_.empty()) between_solids(world);
    if (walls_ && world.list("interface", "walls").active() > 0) with_walls(world);
  }

  std::size_t bytes() const override {
    return map_.bytes() + list_.bytes() + points_.capacity() * sizeof(ContactPoint<Dim>) +
           near_.capacity() * sizeof(Index) + walls_seen_.capacity() * sizeof(WallSums<Dim>) +
           bulk_.capacity() * sizeof(double);
  }

 private:
  ContactPoint<Dim> point_of(Index interface) const {
    const auto& [of, i] = map_.at(interface);
    // What is the same for a whole body was set when the reaches were found.
    ContactPoint<Dim> p = bodies_[static_cast<std::size_t>(of->part[i])];
    p.x = of->position[i];
    p.v = of->velocity[i];
    p.volume = of->reference_volume[i];
    p.mass = of->mass[i];
    return p;
  }
  static bool clamped(const SolidParticle<Dim>& p) { return p.of->clamp[p.i] >= 0; }

  void find_reaches(const World<Dim>& world);
  void find_partners(World<Dim>& world);
  bool may_touch(const World<Dim>& world, Index a, Index b) const;
  void between_solids(World<Dim>& world);
  void see_walls(World<Dim>& world);
  void with_walls(World<Dim>& world);
  void touch_walls(Index interface, double dt, Field<Vec<Dim>>& seen_force, Field<double>& energy);

  // Force on `a` by `b`, and how it grows with the pressures of both.
  Vec<Dim> force(const ContactPoint<Dim>& a, const ContactPoint<Dim>& b, double pressures,
                 double sums, double dt) const;
  static Kernel<Dim> kernel(const ContactPoint<Dim>& a, const ContactPoint<Dim>& b) {
    return Kernel<Dim>(0.5 * std::min(a.reach, b.reach));
  }

  std::vector<std::string> solids_;
  bool walls_;
  InterfaceMap<Dim> map_;
  long arrangement_ = -1;
  std::vector<ContactPoint<Dim>> bodies_;  // what is the same for all particles of a body
  std::vector<WallTouch<Dim>> touch_;      // by body
  std::vector<WallSums<Dim>> walls_seen_;  // by interface particle
  std::vector<double> bulk_;               // by id of the wall's particle
  std::vector<Index> near_;                // interface particles that may touch another solid
  std::vector<ContactPoint<Dim>> points_;  // of them
  std::vector<double> sum_;                // sum of W V at them
  NeighborList list_;                      // among them
};

template <int Dim>
void SolidContact<Dim>::find_reaches(const World<Dim>& world) {
  const ParticleSet<Dim>& interface = world.set("interface");
  bodies_.assign(world.parameters().solids.of.size(), {});
  std::vector<Vec<Dim>> at(static_cast<std::size_t>(interface.size()));
  parallel_for(interface.size(), [&](Index k) {
    const auto& [of, i] = map_.at(k);
    at[static_cast<std::size_t>(k)] = of->reference_position[i];
  });
  double most = 0;
  const auto frame = world.grid("interface").frame();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const SolidPart& p = world.parameters().solids.of[b];
    if (!p.is_solid) continue;
    bodies_[b].reach = 2 * world.set(p.set).smoothing_length();
    most = std::max(most, bodies_[b].reach);
    bodies_[b].stiffness = p.contact_stiffness;
    bodies_[b].impedance = p.contact_damping * std::sqrt(p.contact_stiffness * p.density);
    bodies_[b].friction = p.friction;
  }
  CellGrid<Dim> grid;
  grid.build(at, frame, most);
  const auto& part = interface.tag(fields::part);
  std::vector<double> nearest(at.size(), std::numeric_limits<double>::infinity());
  parallel_for(interface.size(), [&](Index k) {
    if (clamped(map_.at(k))) return;
    double& least = nearest[static_cast<std::size_t>(k)];
    grid.for_each_in_reach(at[static_cast<std::size_t>(k)], most, [&](Index j, double r2) {
      if (part[j] != part[k] && !clamped(map_.at(j))) least = std::min(least, r2);
    });
  });
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    double& reach = bodies_[static_cast<std::size_t>(part[static_cast<Index>(k)])].reach;
    reach = std::min(reach, std::sqrt(nearest[k]) * (1 - 1e-9));
  }
  if (!walls_) return;
  bulk_ = wall_bulk(world);
  touch_ = wall_touches(world, map_, solids_, bulk_);
}

template <int Dim>
bool SolidContact<Dim>::may_touch(const World<Dim>& world, Index a, Index b) const {
  const auto &p = map_.at(a), &q = map_.at(b);
  const std::int32_t part = p.of->part[p.i];
  if (part != q.of->part[q.i]) return true;
  if (!world.parameters().solids[part].self_contact) return false;
  return (p.of->reference_position[p.i] - q.of->reference_position[q.i]).norm() >
         2 * p.of->smoothing_length;
}

// Particles of bodies whose boxes come within reach of each other, and the pairs among them.
template <int Dim>
void SolidContact<Dim>::find_partners(World<Dim>& world) {
  arrangement_ = world.arrangement();
  map_.update(world);
  if (bodies_.empty()) find_reaches(world);
  const ParticleSet<Dim>& interface = world.set("interface");
  // As they were at the rearrangement, also for a run that goes on after it: the order of pairs is
  // that of cells.
  const std::vector<Vec<Dim>> x = world.arranged_positions("interface");
  const auto& part = interface.tag(fields::part);
  // Each body comes 0.2 of its h closer in an advection step; the interface's h is 1.25 of the
  // largest.
  const double radius = 2 * interface.smoothing_length();
  const auto near = meeting_particles<Dim>(world.parameters().solids, part, x, radius);
  near_.assign(near.begin(), near.end());
  if (near_.empty()) return;
  std::vector<Vec<Dim>> at(near.size());
  parallel_for(static_cast<Index>(near.size()), [&](Index k) {
    at[static_cast<std::size_t>(k)] = x[near[static_cast<std::size_t>(k)]];
  });
  CellGrid<Dim> grid;
  grid.build(at, world.grid("interface").frame(), radius);
  list_.template build<Dim>(at, grid, radius, Pairing::within);
  list_.filter([&](Index a, Index b) {
    return may_touch(world, near_[static_cast<std::size_t>(a)], near_[static_cast<std::size_t>(b)]);
  });
  if (list_.pairs() == 0) near_.clear();
}

template <int Dim>
Vec<Dim> SolidContact<Dim>::force(const ContactPoint<Dim>& a, const ContactPoint<Dim>& b,
                                  double pressures, double sums, double dt) const {
  const Vec<Dim> r = a.x - b.x;
  const double r2 = r.squaredNorm();
  const Kernel<Dim> w = kernel(a, b);
  if (r2 >= w.support() * w.support() || r2 == 0) return Vec<Dim>::Zero();
  const Vec<Dim> dv = a.v - b.v;
  const Vec<Dim> e = r / std::sqrt(r2);
  const double closing = -dv.dot(e);
  const double damping = 0.5 * (a.impedance + b.impedance);
  pressures += 2 * damping * std::max(0.0, closing) * std::min(1.0, sums);
  const double push = -pressures * w.dw_over_r(r2) * a.volume * b.volume * std::sqrt(r2);
  Vec<Dim> f = push * e;
  const double friction = std::min(a.friction, b.friction);
  if (friction > 0) {
    const Vec<Dim> slip = dv + closing * e;
    const double speed = slip.norm();
    // No more than what would stop the slip within some steps: a pair is one of many.
    const double mass = a.mass * b.mass / (a.mass + b.mass);
    if (speed > 0) f -= std::min(friction * push / speed, mass / (16 * dt)) * slip;
  }
  return f;
}

template <int Dim>
void SolidContact<Dim>::between_solids(World<Dim>& world) {
  const auto n = near_.size();
  points_.resize(n);
  sum_.assign(n, 0);
  parallel_for(static_cast<Index>(n), [&](Index k) {
    points_[static_cast<std::size_t>(k)] = point_of(near_[static_cast<std::size_t>(k)]);
  });
  auto& energy = world.set("interface").scalar(fields::contact_energy);
  auto& seen = world.set("interface").vector(fields::contact_force);
  const auto blocks = list_.blocks();
  const auto for_pairs = [&](auto&& begin, auto&& pair, auto&& end) {
    parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
      const auto& block = blocks[static_cast<std::size_t>(b)];
      for (std::size_t k = 0; k < block.size(); ++k) {
        if (block.count[k] == 0) continue;
        const std::size_t i = block.targets[k];
        auto sum = begin();
        for (std::uint32_t e = 0; e < block.count[k]; ++e)
          pair(sum, i, static_cast<std::size_t>(block.entries[block.begin[k] + e] / 8));
        end(i, sum);
      }
    });
  };
  for_pairs([] { return 0.0; },
            [&](double& sum, std::size_t i, std::size_t j) {
              sum += kernel(points_[i], points_[j]).w((points_[i].x - points_[j].x).squaredNorm()) *
                     points_[j].volume;
            },
            [&](std::size_t i, double sum) {
              sum_[i] = sum;
              energy[near_[i]] += 0.5 * points_[i].stiffness * points_[i].volume * sum * sum;
            });
  const double dt = world.clock.dt_solid;
  for_pairs([]() -> Vec<Dim> { return Vec<Dim>::Zero(); },
            [&](Vec<Dim>& sum, std::size_t i, std::size_t j) {
              const ContactPoint<Dim>&a = points_[i], &b = points_[j];
              sum += force(a, b, a.stiffness * sum_[i] + b.stiffness * sum_[j],
                           0.5 * (sum_[i] + sum_[j]), dt);
            },
            [&](std::size_t i, const Vec<Dim>& sum) {
              const auto& [of, k] = map_.at(near_[i]);
              (*of->acceleration_sum)[k] += sum / points_[i].mass;
              seen[near_[i]] += sum;
            });
}

template <int Dim>
void SolidContact<Dim>::see_walls(World<Dim>& world) {
  const ParticleSet<Dim>& walls = world.set("walls");
  const auto& y = walls.vector(fields::position);
  const auto& u = walls.vector(fields::velocity);
  const auto& id = walls.ids();
  const double volume = std::pow(walls.spacing(), Dim);
  const auto blocks = world.list("interface", "walls").blocks();
  walls_seen_.resize(static_cast<std::size_t>(world.set("interface").size()));
  for (WallTouch<Dim>& t : touch_) t.touching = 0;
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    const auto& block = blocks[static_cast<std::size_t>(b)];
    for (std::size_t k = 0; k < block.size(); ++k) {
      const Index interface = block.targets[k];
      WallSums<Dim>& seen = walls_seen_[static_cast<std::size_t>(interface)] = {};
      const SolidParticle<Dim>& p = map_.at(interface);
      if (clamped(p)) continue;
      WallTouch<Dim>& touch = touch_[static_cast<std::size_t>(p.of->part[p.i])];
      const Kernel<Dim>& kernel = touch.kernel;
      for (std::uint32_t e = 0; e < block.count[k]; ++e) {
        const auto w = static_cast<Index>(block.entries[block.begin[k] + e] / 8);
        const Vec<Dim> r = p.of->position[p.i] - y[w];
        const double r2 = r.squaredNorm();
        if (r2 >= kernel.support() * kernel.support()) continue;
        const double share = kernel.w(r2) * volume;
        seen.sum += share;
        seen.gradient += kernel.dw_over_r(r2) * volume * r;
        seen.velocity += share * u[w];
        seen.bulk += share * bulk_[static_cast<std::size_t>(id[w])];
      }
      if (seen.sum <= 0) continue;
      seen.velocity /= seen.sum;
      seen.bulk /= seen.sum;
      if (seen.sum > touch.reference_overlap * seen.bulk)
        std::atomic_ref(touch.touching).fetch_add(1);  // a count depends on no order
    }
  });
}

template <int Dim>
void SolidContact<Dim>::with_walls(World<Dim>& world) {
  see_walls(world);
  const double dt = world.clock.dt_solid;
  auto& energy = world.set("interface").scalar(fields::contact_energy);
  auto& seen_force = world.set("interface").vector(fields::contact_force);
  const auto blocks = world.list("interface", "walls").blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    for (const std::uint32_t interface : blocks[static_cast<std::size_t>(b)].targets)
      touch_walls(static_cast<Index>(interface), dt, seen_force, energy);
  });
}

template <int Dim>
void SolidContact<Dim>::touch_walls(Index interface, double dt, Field<Vec<Dim>>& seen_force,
                                    Field<double>& energy) {
  const WallSums<Dim>& seen = walls_seen_[static_cast<std::size_t>(interface)];
  const auto& [of, i] = map_.at(interface);
  const WallTouch<Dim>& body = touch_[static_cast<std::size_t>(of->part[i])];
  const double excess = seen.sum - body.reference_overlap * seen.bulk,
               steepness = seen.gradient.norm();
  if (excess <= 0 || steepness <= 0) return;
  const ContactPoint<Dim> p = point_of(interface);
  const Vec<Dim> n = -seen.gradient / steepness, dv = p.v - seen.velocity;
  const double closing = -dv.dot(n);
  // The reference overlap is subtracted: with this the pressure of Eq. 79 at half a spacing, all of
  // the sum in the kernel of solids.
  const double stiffness = 3 * p.stiffness;
  const double pressure = 2 * (stiffness * excess + p.impedance * std::max(0.0, closing));
  const double push = pressure * p.volume * steepness;
  Vec<Dim> f = push * n;
  const Vec<Dim> slip = dv + closing * n;
  const double speed = slip.norm();
  if (p.friction > 0 && speed > 0) {
    // No more than what stops the slip within some steps: of a particle, or of the whole body by
    // all that touch.
    const double most =
        body.rigid ? body.mass / (8 * static_cast<double>(body.touching) * dt) : p.mass / (4 * dt);
    f -= std::min(p.friction * push / speed, most) * slip;
  }
  (*of->acceleration_sum)[i] += f / p.mass;
  seen_force[interface] += f;
  energy[interface] += stiffness * p.volume * excess * excess;
}

const RegisterEffect<SolidContact> registered_solid_contact;

}  // namespace
}  // namespace sphgeo
