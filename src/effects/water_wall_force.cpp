#include "effects/effect.h"
#include "effects/wall_pair.h"

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
  void operator()(Sums<T>& sum, const Record<Dim, T, 2>& i, const Record<Dim, T, 2>& j,
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
  void operator()(Sums<T>& sum, const Record<Dim, T, 2>& i, const Record<Dim, T, 2>& j,
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
    return {"water_wall_force", Stage::force, "Eqs. 73, 74", "pressure (one-sided Riemann) and friction of walls on the water", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water") || !world.find("walls")) return {"there is no water, or there are no walls"};
    return {std::make_unique<WaterWallForce>(world), "there are water and walls"};
  }

  explicit WaterWallForce(const World<Dim>& world) : porous_(world.find("soil") != nullptr) {
    if (porous_) need_volume_share(world, volume_);
  }

  std::string acts_on() const override { return "water near walls"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::density, Access::read}, {"water", &fields::pressure, Access::read},
             {"water", &fields::acceleration, Access::read},
             {"water", &fields::acceleration_sum, Access::add}, {"walls", &fields::volume, Access::read}},
            {{"water", "walls"}}};
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    if (porous_) n.fields.push_back({"water", &fields::pressure_force, Access::add});
    return n;
  }
  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    world.records("water", 1);
  }

  void apply(World<Dim>& world) override {
    if (porous_) run<WallForceOnPoreWater<Dim>>(world);
    else run<WallForceOnWater<Dim>>(world);
  }

 private:
  template <class Pair>
  void run(World<Dim>& world) {
    constexpr bool porous = std::is_same_v<Pair, WallForceOnPoreWater<Dim>>;
    const WaterConstants w = WaterConstants::of(world);
    const Pair pair{WallPair<Dim>(w, water_->smoothing_length(), water_->spacing())};
    const Field<double>* n = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    Field<Vec<Dim>>* pressure_force = porous ? &water_->vector(fields::pressure_force) : nullptr;
    const auto& rho = water_->scalar(fields::density);
    auto& sum_of_forces = water_->vector(fields::acceleration_sum);
    const NeighborList& list = world.list("water", "walls");
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      pack_pull(world, list, world.records("water", 1).template get<T>());
      gather<Pair::template Sums>(
          list, with(world.records("water", 0).template get<T>(), world.records("water", 1).template get<T>()),
          with(world.records("walls", 0).template get<T>(), world.records("walls", 1).template get<T>()), pair,
          [&](Index i, const auto& sum) {
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

  // g - dv/dt and the density, of the water that a wall can reach; with drag, grad p / rho = g - dv/dt + drag. The drag is that of the
  // last step, too: this step's comes after all other forces, so it is not named among the needs.
  template <class T>
  void pack_pull(const World<Dim>& world, const NeighborList& list, Records<Dim, T>& records) {
    const auto& x = water_->vector(fields::position);
    const auto& a = water_->vector(fields::acceleration);
    const auto& rho = water_->scalar(fields::density);
    const Field<Vec<Dim>>* drag = water_->has(fields::drag_acceleration) ? &water_->vector(fields::drag_acceleration) : nullptr;
    const auto blocks = list.blocks();
    parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
      for (const std::uint32_t i : blocks[static_cast<std::size_t>(b)].targets) {
        T* slot = records[i] - record_size;
        Vec<Dim> pull = world.pull(x[i]) - a[i];
        if (drag) pull += (*drag)[i];
        for (int k = 0; k < Dim; ++k) slot[water_slot::pull + k] = static_cast<T>(pull[k]);
        slot[water_slot::density] = static_cast<T>(rho[i]);
      }
    });
  }

  bool porous_;
  Needs volume_;  // what the volume needs beside mass and density
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterWallForce> registered;

}  // namespace
}  // namespace sphgeo
