#include "effects/effect.h"
#include "effects/soil_wall_pair.h"

namespace sphgeo {
namespace {

/// Force of the soil on every wall particle (Eq. 70).
template <int Dim>
class SoilWallReaction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_wall_reaction", Stage::observe, "Eq. 70", "force of the soil on wall particles",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil") || !world.find("walls"))
      return {"there is no soil, or there are no walls"};
    return {std::make_unique<SoilWallReaction>(world.find("water") != nullptr),
            "there are soil and walls"};
  }

  /// Where there is water too, its reaction comes first.
  explicit SoilWallReaction(bool adds) : adds_(adds) {}

  std::string acts_on() const override { return "walls near soil"; }
  Needs needs() const override {
    Needs n{{{"walls", &fields::wall_force, adds_ ? Access::add : Access::write}},
            {{"walls", "soil"}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, true);
    need_wall_records<Dim>(n, "walls");
    return n;
  }
  void prepare(World<Dim>& world) override {
    walls_ = &world.set("walls");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    const SoilForceOnWall<Dim> pair{SoilWallPair<Dim>(world, *soil_)};
    auto& force = walls_->vector(fields::wall_force);
    if (!adds_) parallel_for(walls_->size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<SoilForceOnWall<Dim>::template Sums>(
          world.list("walls", "soil"), wall_records<T>(world, "walls"),
          soil_records<T, true>(world), pair,
          [&](Index i, const auto& sum) { force[i] += to_vec(sum.force); });
    });
  }

 private:
  bool adds_;
  ParticleSet<Dim>* walls_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilWallReaction> registered_soil_wall_reaction;

}  // namespace
}  // namespace sphgeo
