#include "effects/effect.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

template <int Dim>
struct WallDivergence {
  WallPair<Dim> wall;

  template <class T>
  struct Sums {
    T divergence{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T>& i, const Record<Dim, T, 2>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.divergence += wall.divergence(i, j, r, r2);
  }
};

/// What walls add to the rate of density (Eq. 58 with the mirrored velocity of Eq. 95).
template <int Dim>
class WaterWallContinuity final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_wall_continuity", Stage::rate, "Eqs. 58, 95",
            "divergence and density dissipation against walls", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_walls<WaterWallContinuity>(world, "water");
  }

  WaterWallContinuity(const World<Dim>& world, std::string walls)
      : walls_(std::move(walls)), porous_(volume_follows_porosity(world)) {}

  std::string acts_on() const override { return near_walls("water", walls_); }
  Needs needs() const override {
    Needs n{
        {{"water", &fields::density, Access::read}, {"water", &fields::density_rate, Access::add}},
        {}};
    need_walls(n, "water", {walls_});
    if (porous_) {
      n.fields.push_back({"water", &fields::water_fraction, Access::read});
      n.fields.push_back(
          {"water", &fields::soil_velocity, Access::read});  // the records hold the mixture's
    }
    return n;
  }
  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    const WallDivergence<Dim> pair{
        WallPair<Dim>(world.parameters().water, water_->smoothing_length(), water_->spacing())};
    const auto& rho = water_->scalar(fields::density);
    auto& rate = water_->scalar(fields::density_rate);
    const Field<double>* n = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<WallDivergence<Dim>::template Sums>(
          world.list("water", walls_), world.records("water").template get<T>(),
          with(world.records(walls_, 0).template get<T>(),
               world.records(walls_, 1).template get<T>()),
          pair, [&](Index i, const auto& sum) {
            rate[i] += rho[i] *
                       (n ? (*scale)[i] * (*scale)[i] * sum.divergence / (*n)[i] : sum.divergence);
          });
    });
  }

 private:
  std::string walls_;
  bool porous_;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterWallContinuity> registered_water_wall_continuity;

}  // namespace
}  // namespace sphgeo
