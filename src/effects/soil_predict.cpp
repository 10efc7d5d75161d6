#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/soil_phase.h"

namespace sphgeo {
namespace {

/// Volume fraction, position and volume at the middle of the acoustic step (Eq. 96).
template <int Dim>
class SoilPredict final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_predict", Stage::predict, "Eqs. 1, 96",
            "volume fraction, position and volume of soil at the middle of the step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    return {std::make_unique<SoilPredict>(world), "there is soil"};
  }

  explicit SoilPredict(const World<Dim>& world)
      : parameters_(soil_parameters_used(world)),
        current_geometry_(world.parameters().numerics.soil_pair_geometry == PairGeometry::current) {
  }

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::volume_fraction, Access::update},
             {"soil", &fields::position, Access::update},
             {"soil", &fields::volume_fraction_rate, Access::read},
             {"soil", &fields::velocity, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::stress, Access::read},
             {"soil", &fields::gradient_correction, Access::read},
             {"soil", &fields::volume, Access::write}},
            {}};
    need_soil_packing<Dim>(n, parameters_);
    if (current_geometry_) n.record<Position<Dim>>("soil", Access::update);
    return n;
  }

  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    const double half = 0.5 * world.clock.dt_acoustic;
    const SoilParameters& parts = world.parameters().soil;
    auto& n = soil_->scalar(fields::volume_fraction);
    auto& x = soil_->vector(fields::position);
    auto& volume = soil_->scalar(fields::volume);
    const auto& rate = soil_->scalar(fields::volume_fraction_rate);
    const auto& v = soil_->vector(fields::velocity);
    const auto& m = soil_->scalar(fields::mass);
    const auto& part = soil_->tag(fields::part);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      std::optional<RecordPacking<Position<Dim>, T>> positions;
      if (current_geometry_) positions = write_records<Position<Dim>, T>(world, "soil");
      const SoilPacking<Dim, T> pack(world, *soil_);
      parallel_for(soil_->size(), [&](Index i) {
        n[i] += half * rate[i];
        x[i] += half * v[i];
        volume[i] = m[i] / (n[i] * parts[part[i]].grain_density);
        pack(i);
        if (positions) positions->set_position(i, x[i]);
      });
    });
  }

  void bounds(const World<Dim>&, std::vector<FieldBound>& watched) const override {
    watched.push_back({"soil", &fields::volume_fraction, 0.0, 4.0,
                       "soil that comes apart faster than its time step resolves: something has "
                       "thrown it, such as a start inside of a wall or body, or a fast impact",
                       "soil compressed by pressures of the order of its bulk modulus: bodies that "
                       "start inside each other, or a youngs_modulus that is too low"});
  }

 private:
  bool parameters_, current_geometry_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilPredict> registered_soil_predict;

}  // namespace
}  // namespace sphgeo
