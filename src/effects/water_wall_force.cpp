#include "effects/water_wall_force.h"
#include "effects/effect.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

template <int Dim>
struct WallForceOnWater {
  WallPair<Dim> wall;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const WaterAtWall<Dim, T>& i, const WallRecord<Dim, T>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.force += wall.force(i, j, r, r2);
  }
};

/// The same in two sums: pressure also acts on soil in the water.
template <int Dim>
struct WallForceOnPoreWater {
  WallPair<Dim> wall;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> pressure{}, friction{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const WaterAtWall<Dim, T>& i, const WallRecord<Dim, T>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.pressure += wall.pressure(i, j, r, r2);
    sum.friction += wall.friction(i, j, r2);
  }
};

/// Pressure and friction of walls on the water by a one-sided Riemann problem (Eqs. 73, 74).
template <int Dim>
class WaterWallForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_wall_force", Stage::force, "Eqs. 73, 74",
            "pressure (one-sided Riemann) and friction of walls on the water", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_walls<WaterWallForce>(world, "water");
  }

  WaterWallForce(const World<Dim>& world, std::string walls)
      : walls_(std::move(walls)), porous_(world.find("soil") != nullptr) {
    if (porous_) need_volume_share(world, volume_);
  }

  std::string acts_on() const override { return near_walls("water", walls_); }
  Needs needs() const override {
    Needs n{{{"water", &fields::acceleration_sum, Access::add}}, {{"water", walls_}}};
    need_pressure_gradient<Dim>(n);
    n.record<Position<Dim>>("water", Access::read);
    n.record<packed::WaterState<Dim>>("water", Access::read);
    need_wall_records<Dim>(n, walls_);
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    if (porous_) n.fields.push_back({"water", &fields::pressure_force, Access::add});
    return n;
  }
  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    if (porous_) run<WallForceOnPoreWater<Dim>>(world);
    else run<WallForceOnWater<Dim>>(world);
  }

 private:
  template <class Pair>
  void run(World<Dim>& world) {
    constexpr bool porous = std::is_same_v<Pair, WallForceOnPoreWater<Dim>>;
    const WaterParameters& w = world.parameters().water;
    const Pair pair{WallPair<Dim>(w, water_->smoothing_length(), water_->spacing())};
    const Field<double>* n = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    Field<Vec<Dim>>* pressure_force = porous ? &water_->vector(fields::pressure_force) : nullptr;
    const auto& rho = water_->scalar(fields::density);
    auto& sum_of_forces = water_->vector(fields::acceleration_sum);
    const NeighborList& list = world.list("water", walls_);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto gradient = write_records<packed::PressureGradient<Dim>, T>(world, "water");
      pack_pressure_gradient(world, list, gradient);
      gather<Pair::template Sums>(
          list, with<T>(read_records<packed::WaterState<Dim>, T>(world, "water"), gradient),
          wall_records<T>(world, walls_), pair, [&](Index i, const auto& sum) {
            if constexpr (porous) {
              Vec<Dim> pressure = to_vec(sum.pressure);
              if (scale) pressure *= (*scale)[i] * (*scale)[i];
              (*pressure_force)[i] += pressure;
              sum_of_forces[i] += (pressure + to_vec(sum.friction) / (n ? (*n)[i] : 1.0)) / rho[i];
            } else {
              sum_of_forces[i] += to_vec(sum.force) / rho[i];
            }
          });
    });
  }

  std::string walls_;
  bool porous_;
  Needs volume_;  // what the volume needs beside mass and density
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterWallForce> registered_water_wall_force;

}  // namespace
}  // namespace sphgeo
