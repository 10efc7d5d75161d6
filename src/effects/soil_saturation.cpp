#include <algorithm>

#include "effects/effect.h"
#include "effects/pore_water.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Share of the kernel that a set fills, by the volumes of record type R.
template <int Dim, class R>
struct FilledShare {
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T share{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, packed::Pore<Dim>>&, const Record<T, R>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.share += kernel.w(r2) * j[R::volume];
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
    need_pore_pairs<Dim>(n);
    n.record<packed::PoreVolume<Dim>>("water", Access::scratch);
    need_wall_volumes<Dim>(n, "soil", walls_);
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
      using PoreVolume = packed::PoreVolume<Dim>;
      const auto water = write_records<PoreVolume, T>(world, "water");
      const auto soil = read_records<packed::Pore<Dim>, T>(world, "soil");
      for_targets(world.list("water", "soil"),
                  [&](Index i) { water[i].put(PoreVolume::volume, m[i] / (n[i] * rho[i])); });
      for (const std::string& set : walls_) {
        using Pair = FilledShare<Dim, packed::Wall<Dim>>;
        gather<Pair::template Sums>(
            world.list("soil", set), soil, read_records<packed::Wall<Dim>, T>(world, set),
            Pair{kernel}, [&](Index k, const auto& s) {
              inside[static_cast<std::size_t>(k)] =
                  std::max(0.1, inside[static_cast<std::size_t>(k)] - s.share);
            });
      }
      using Pair = FilledShare<Dim, PoreVolume>;
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
