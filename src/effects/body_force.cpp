#include "core/parallel.h"
#include "effects/effect.h"
#include "sph/parameters.h"

namespace sphgeo {
namespace {

/// The deck's body force on the water, beside gravity, which the momentum of the water starts from.
template <int Dim>
class BodyForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"body_force", Stage::force, "Eq. 60, g", "the body force of the deck, beside gravity",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    if (!world.parameters().body_force)
      return {"the deck has no body_force; gravity comes with water_momentum"};
    return {std::make_unique<BodyForce>(), "the deck has a body_force"};
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    return {{{"water", &fields::position, Access::read},
             {"water", &fields::acceleration_sum, Access::add}},
            {}};
  }
  void prepare(World<Dim>& world) override {
    acceleration_ = &world.set("water").vector(fields::acceleration_sum);
  }
  void apply(World<Dim>& world) override {
    const auto& x = world.set("water").vector(fields::position);
    parallel_for(acceleration_->size(), [&](Index i) {
      (*acceleration_)[i] += world.body_acceleration(x[i]) - world.gravity();
    });
  }

 private:
  Field<Vec<Dim>>* acceleration_ = nullptr;
};

const RegisterEffect<BodyForce> registered_body_force;

}  // namespace
}  // namespace sphgeo
