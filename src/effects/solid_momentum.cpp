#include "core/parallel.h"
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
  template <class T, int N>
  void operator()(Sums<T>& sum, const Record<Dim, T, N>& i, const Record<Dim, T, N>& j, const LaneVec<Dim, T>& r, const T& r2) const {
    T both[Dim * Dim];
    for (int k = 0; k < Dim * Dim; ++k) both[k] = i[solid_slot::piola<Dim>(k)] + j[solid_slot::piola<Dim>(k)];
    sum.force += kernel.dw_over_r(r2) * times(both, r);
  }
};

/// Internal forces of elastic solids (Eq. 65). With the deformation of Eq. 67 they are the gradient of the strain
/// energy, so that nothing but the time step changes the energy.
template <int Dim>
class SolidMomentum final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_momentum", Stage::solid_force, "Eq. 65", "internal forces of elastic solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidMomentum>(world); }

  explicit SolidMomentum(std::string set) : set_(std::move(set)) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    return {{{set_, &fields::reference_volume, Access::read}, {set_, &fields::mass, Access::read},
             {set_, &fields::acceleration_sum, Access::write}}, {}, {set_}};
  }

  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    const auto& volume = set.scalar(fields::reference_volume);
    const auto& m = set.scalar(fields::mass);
    auto& sum_of_forces = set.vector(fields::acceleration_sum);
    const PiolaForce<Dim> pair{Kernel<Dim>(set.smoothing_length())};
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto finish = [&](Index i, const auto& sum) { sum_of_forces[i] = (volume[i] * volume[i] / m[i]) * to_vec(sum.force); };
      const auto& one = world.records(set_, 1).template get<T>();
      if constexpr (Dim == 2) {
        gather<PiolaForce<Dim>::template Sums>(world.reference_list(set_), one, one, pair, finish);
      } else {
        const auto both = with(one, world.records(set_, 2).template get<T>());
        gather<PiolaForce<Dim>::template Sums>(world.reference_list(set_), both, both, pair, finish);
      }
    });
  }

 private:
  std::string set_;
};

const RegisterEffect<SolidMomentum> registered;

}  // namespace
}  // namespace sphgeo
