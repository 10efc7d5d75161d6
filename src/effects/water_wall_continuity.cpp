#include "effects/effect.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// `Moving` is the record with the velocity: packed::WaterState, or packed::Mixture in soil.
template <int Dim, class Moving>
struct WallDivergence {
  WallPair<Dim> wall;

  template <class T>
  struct Sums {
    T divergence{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Moving>& i, const WallRecord<Dim, T>& j,
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
        {{"water", walls_}}};
    n.record<Position<Dim>>("water", Access::read);
    need_wall_records<Dim>(n, walls_);
    // The mixture's velocity lies over the state of the water, whose other numbers come with it.
    using Water = packed::WaterState<Dim>;
    if (porous_) {
      n.fields.push_back({"water", &fields::water_fraction, Access::read});
      n.record<Water>("water", Access::read, Water::volume, Water::pressure);
      n.record<packed::Mixture<Dim>>("water", Access::read);
    } else {
      n.record<Water>("water", Access::read, Water::velocity);
    }
    return n;
  }
  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    if (porous_) run<packed::Mixture<Dim>>(world);
    else run<packed::WaterState<Dim>>(world);
  }

 private:
  template <class Moving>
  void run(World<Dim>& world) {
    using Pair = WallDivergence<Dim, Moving>;
    const Pair pair{
        WallPair<Dim>(world.parameters().water, water_->smoothing_length(), water_->spacing())};
    const auto& rho = water_->scalar(fields::density);
    auto& rate = water_->scalar(fields::density_rate);
    const Field<double>* n = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<Pair::template Sums>(
          world.list("water", walls_), read_records<Moving, T>(world, "water"),
          wall_records<T>(world, walls_), pair, [&](Index i, const auto& sum) {
            rate[i] += rho[i] *
                       (n ? (*scale)[i] * (*scale)[i] * sum.divergence / (*n)[i] : sum.divergence);
          });
    });
  }

  std::string walls_;
  bool porous_;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterWallContinuity> registered_water_wall_continuity;

}  // namespace
}  // namespace sphgeo
