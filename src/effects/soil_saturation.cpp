#include <algorithm>

#include "effects/effect.h"
#include "effects/pore_water.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Share of the kernel that a set fills, by the volumes in its first records or those of the pairs
/// of water and soil.
template <int Dim, int VolumeSlot>
struct FilledShare {
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T share{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T>&, const Record<Dim, T>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.share += kernel.w(r2) * j[VolumeSlot];
  }
};

/// Degree of saturation of the soil (Eq. 68), once per advection step. At walls the sum is divided
/// by the share of the kernel that lies outside of them.
template <int Dim>
class SoilSaturation final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_saturation", Stage::reinitialize, "Eq. 68",
            "degree of saturation: how much of a soil particle's kernel holds water", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    return {std::make_unique<SoilSaturation>(wall_sets(world)), "there are water and soil"};
  }

  explicit SoilSaturation(std::vector<std::string> walls) : walls_(std::move(walls)) {}

  std::string acts_on() const override { return "soil near water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::water_fraction, Access::read},
             {"water", &fields::density, Access::read},
             {"water", &fields::mass, Access::read},
             {"soil", &fields::saturation, Access::write}},
            {{"soil", "water"}, {"water", "soil"}}};
    need_walls(n, "soil", walls_);
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    const Kernel<Dim> kernel(water_->smoothing_length());
    const auto& n = water_->scalar(fields::water_fraction);
    const auto& rho = water_->scalar(fields::density);
    const auto& m = water_->scalar(fields::mass);
    auto& wet = soil_->scalar(fields::saturation);
    std::vector<double> inside(static_cast<std::size_t>(soil_->size()), 1.0);
    parallel_for(soil_->size(), [&](Index k) { wet[k] = 0; });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& water = pore_records<T>(world, "water");
      const auto& soil = pore_records<T>(world, "soil");
      for_targets(world.list("water", "soil"), [&](Index i) {
        water[i][pore_slot::other] = static_cast<T>(m[i] / (n[i] * rho[i]));
      });
      for (const std::string& set : walls_) {
        using Pair = FilledShare<Dim, wall_slot::volume>;
        gather<Pair::template Sums>(
            world.list("soil", set), soil, world.records(set).template get<T>(), Pair{kernel},
            [&](Index k, const auto& s) {
              inside[static_cast<std::size_t>(k)] =
                  std::max(0.1, inside[static_cast<std::size_t>(k)] - s.share);
            });
      }
      using Pair = FilledShare<Dim, pore_slot::other>;
      gather<Pair::template Sums>(
          world.list("soil", "water"), soil, water, Pair{kernel}, [&](Index k, const auto& s) {
            wet[k] = std::min(1.0, s.share / inside[static_cast<std::size_t>(k)]);
          });
    });
  }

 private:
  std::vector<std::string> walls_;  // sets of walls
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilSaturation> registered_soil_saturation;

}  // namespace
}  // namespace sphgeo
