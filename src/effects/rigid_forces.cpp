#include "core/parallel.h"
#include "effects/rigid_body.h"

namespace sphgeo {
namespace {

/// Starts the sum of forces on solids that are all rigid: nothing acts inside of them.
template <int Dim>
class RigidForces final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"rigid_forces", Stage::solid_force, "Eq. 65",
            "starts the sum of forces on particles of rigid solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    Binding<Dim> binding = bind_solids<RigidForces>(world, true);
    // Where there are elastic solids too, their internal forces start the sum.
    std::erase_if(binding.effects, [&](const auto& e) {
      const auto& of = world.parameters().solids.of;
      return std::any_of(of.begin(), of.end(), [&](const SolidPart& p) {
        return p.elastic && p.set == static_cast<const RigidForces&>(*e).set_;
      });
    });
    if (binding.effects.empty()) binding.because = "there are no solids that are all rigid";
    return binding;
  }

  explicit RigidForces(std::string set) : set_(std::move(set)) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override { return {{{set_, &fields::acceleration_sum, Access::write}}, {}}; }
  void apply(World<Dim>& world) override {
    auto& sum = world.set(set_).vector(fields::acceleration_sum);
    parallel_for(sum.size(), [&](Index i) { sum[i].setZero(); });
  }

 private:
  std::string set_;
};

const RegisterEffect<RigidForces> registered_rigid_forces;

}  // namespace
}  // namespace sphgeo
