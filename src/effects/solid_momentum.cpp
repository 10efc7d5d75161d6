#include "core/parallel.h"
#include "effects/piola_records.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Sum of (P_i B_i + P_j B_j) . grad W at rest.
template <int Dim>
struct PiolaForce {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T, class... R>
  void operator()(Sums<T>& sum, const Record<T, R...>& i, const Record<T, R...>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    T both[Dim * Dim];
    constexpr int first = packed::first_piola_numbers<Dim>;
    for (int k = 0; k < first; ++k)
      both[k] = i.at(packed::Piola<Dim>::numbers, k) + j.at(packed::Piola<Dim>::numbers, k);
    if constexpr (Dim == 3)
      for (int k = first; k < Dim * Dim; ++k)
        both[k] = i.at(packed::PiolaRest::numbers, k - first) +
                  j.at(packed::PiolaRest::numbers, k - first);
    sum.force += kernel.dw_over_r(r2) * times(both, r);
  }
};

/// With a viscosity along the line between both particles as they are now, which keeps momentum and
/// angular momentum.
template <int Dim>
struct ViscousPiolaForce {
  PiolaForce<Dim> stress;
  double softening;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{}, viscous{};
  };
  template <class T, class... R>
  void operator()(Sums<T>& sum, const Record<T, R...>& i, const Record<T, R...>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    using Motion = packed::SolidMotion<Dim>;
    typename PiolaForce<Dim>::template Sums<T> elastic{sum.force};
    stress(elastic, i, j, r, r2);
    sum.force = elastic.force;
    const LaneVec<Dim, T> now = r + i.vec(Motion::displacement) - j.vec(Motion::displacement);
    const LaneVec<Dim, T> dv = i.vec(Motion::velocity) - j.vec(Motion::velocity);
    sum.viscous +=
        (stress.kernel.dw_over_r(r2) * dot(dv, now) / (dot(now, now) + T(softening))) * now;
  }
};

/// Internal forces of elastic solids (Eq. 65). With the deformation of Eq. 67 they are the gradient
/// of the strain energy, so that nothing but the time step changes the energy.
///
/// The gradients do not see deformations that alternate from particle to particle, and nothing
/// takes the energy of waves as short as the spacing, which impacts and the forces of water feed. A
/// deck may ask for a viscosity that does.
template <int Dim>
class SolidMomentum final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_momentum", Stage::solid_force, "Eq. 65", "internal forces of elastic solids",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidMomentum>(world); }

  explicit SolidMomentum(std::string set, bool viscous) : set_(std::move(set)), viscous_(viscous) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    Needs n{{{set_, &fields::reference_volume, Access::read},
             {set_, &fields::mass, Access::read},
             {set_, &fields::acceleration_sum, Access::write}},
            {},
            {set_}};
    n.record<packed::Piola<Dim>>(set_, Access::read, packed::Piola<Dim>::position);
    need_piola<Dim>(n, set_, Access::read);
    if (viscous_) n.record<packed::SolidMotion<Dim>>(set_, Access::read);
    return n;
  }

  void apply(World<Dim>& world) override {
    const ParticleSet<Dim>& set = world.set(set_);
    const Kernel<Dim> kernel(set.smoothing_length());
    if (viscous_) run(world, ViscousPiolaForce<Dim>{{kernel}, 0.01 * kernel.h * kernel.h});
    else run(world, PiolaForce<Dim>{kernel});
  }

 private:
  template <class Pair>
  void run(World<Dim>& world, const Pair& pair) {
    constexpr bool viscous = std::is_same_v<Pair, ViscousPiolaForce<Dim>>;
    ParticleSet<Dim>& set = world.set(set_);
    const auto& volume = set.scalar(fields::reference_volume);
    const auto& m = set.scalar(fields::mass);
    const auto& part = set.tag(fields::part);
    auto& sum_of_forces = set.vector(fields::acceleration_sum);
    const SolidParameters& parts = world.parameters().solids;
    const PairWeights<Dim>& more = world.reference_weights(set_);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const PiolaReading<Dim, T> stress(world, set_);
      const auto walk = [&](const auto& all) {
        gather<Pair::template Sums>(
            world.reference_list(set_), all, all, pair, [&](Index i, const auto& sum) {
              Vec<Dim> force = to_vec(sum.force);
              if constexpr (viscous)
                force += parts[part[i]].viscosity * set.smoothing_length() * to_vec(sum.viscous);
              force *= volume[i];
              if (!more.empty())
                more.by_source.for_row(i, [&](Index k, const float* weight) {
                  for (int a = 0; a < Dim; ++a)
                    for (int c = 0; c < Dim; ++c)
                      force[a] -= stress.get(k, a * Dim + c) * static_cast<double>(weight[c]);
                });
              sum_of_forces[i] = (volume[i] / m[i]) * force;
            });
      };
      if constexpr (viscous)
        walk(stress.with_more(read_records<packed::SolidMotion<Dim>, T>(world, set_)));
      else walk(stress.with_more());
    });
  }

  std::string set_;
  bool viscous_;
};

const RegisterEffect<SolidMomentum> registered_solid_momentum;

}  // namespace
}  // namespace sphgeo
