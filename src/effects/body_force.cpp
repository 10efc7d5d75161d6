#include "core/parallel.h"
#include "effects/effect.h"

namespace sphgeo {
namespace {

/// Starts the acceleration of the water with gravity (last-but-one term of Eq. 60).
template <int Dim>
class BodyForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"body_force", Stage::force, "Eq. 60, g", "gravity and the body force of the deck start the sum of accelerations", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<BodyForce>(), "every sum of accelerations starts here"};
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override { return {{{"water", &fields::position, Access::read}, {"water", &fields::acceleration_sum, Access::write}}, {}}; }
  void prepare(World<Dim>& world) override { acceleration_ = &world.set("water").vector(fields::acceleration_sum); }
  void apply(World<Dim>& world) override {
    const auto& x = world.set("water").vector(fields::position);
    parallel_for(acceleration_->size(), [&](Index i) { (*acceleration_)[i] = world.pull(x[i]); });
  }

 private:
  Field<Vec<Dim>>* acceleration_ = nullptr;
};

const RegisterEffect<BodyForce> registered;

}  // namespace
}  // namespace sphgeo
