#include "effects/effect.h"
#include "effects/soil_wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

template <int Dim>
struct WallForceOnSoil {
  SoilWallPair<Dim> wall;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const SoilRecord<Dim, T>& i, const WallRecord<Dim, T>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.force += wall.force(i, j, r, r2);
  }
};

/// Force of walls on the soil by a one-sided Riemann problem (Eqs. 69, 95).
template <int Dim>
class SoilWallForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_wall_force", Stage::force, "Eqs. 69, 95",
            "stress and dissipation (one-sided Riemann) of walls on the soil", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (world.find("soil") && !world.parameters().soil.deformable)
      return {"no skeleton is deformable"};
    return bind_walls<SoilWallForce>(world, "soil");
  }

  SoilWallForce(const World<Dim>&, std::string walls) : walls_(std::move(walls)) {}

  std::string acts_on() const override { return near_walls("soil", walls_); }
  Needs needs() const override {
    Needs n{{{"soil", &fields::volume, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::acceleration_sum, Access::add}},
            {{"soil", walls_}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, true);
    need_wall_records<Dim>(n, walls_);
    return n;
  }
  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    const WallForceOnSoil<Dim> pair{SoilWallPair<Dim>(world, *soil_)};
    const auto& m = soil_->scalar(fields::mass);
    const auto& volume = soil_->scalar(fields::volume);
    auto& sum_of_forces = soil_->vector(fields::acceleration_sum);
    const NeighborList& list = world.list("soil", walls_);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<WallForceOnSoil<Dim>::template Sums>(
          list, soil_records<T, true>(world), wall_records<T>(world, walls_), pair,
          [&](Index i, const auto& sum) {
            sum_of_forces[i] += to_vec(sum.force) * (volume[i] / m[i]);
          });
    });
  }

 private:
  std::string walls_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilWallForce> registered_soil_wall_force;

}  // namespace
}  // namespace sphgeo
