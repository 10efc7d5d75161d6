#include "core/parallel.h"
#include "effects/effect.h"

namespace sphgeo {
namespace {

/// Starts the acceleration of water or soil with gravity (last-but-one term of Eq. 60).
template <int Dim>
class BodyForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"body_force", Stage::force, "Eq. 60, g", "gravity and the body force of the deck start the sum of accelerations", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    Binding<Dim> binding("there is neither water nor soil");
    for (const char* set : {"water", "soil"})
      if (world.find(set)) binding.effects.push_back(std::make_unique<BodyForce>(set));
    if (!binding.effects.empty()) binding.because = "every sum of accelerations starts here";
    return binding;
  }

  explicit BodyForce(std::string set) : set_(std::move(set)) {}

  std::string acts_on() const override { return set_; }
  Needs needs() const override { return {{{set_, &fields::position, Access::read}, {set_, &fields::acceleration_sum, Access::write}}, {}}; }
  void prepare(World<Dim>& world) override { acceleration_ = &world.set(set_).vector(fields::acceleration_sum); }
  void apply(World<Dim>& world) override {
    const auto& x = world.set(set_).vector(fields::position);
    parallel_for(acceleration_->size(), [&](Index i) { (*acceleration_)[i] = world.pull(x[i]); });
  }

 private:
  std::string set_;
  Field<Vec<Dim>>* acceleration_ = nullptr;
};

const RegisterEffect<BodyForce> registered;

}  // namespace
}  // namespace sphgeo
