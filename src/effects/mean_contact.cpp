#include "core/parallel.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Mean of the contact forces over all steps of solids in the advection step, for probes.
template <int Dim>
class MeanContact final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"mean_contact", Stage::solid_force, "-",
            "mean over the advection step of the contact forces on solids", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface")) return {"there are no solids"};
    return {std::make_unique<MeanContact>(), "there are solids"};
  }

  std::string acts_on() const override { return "interface"; }
  Needs needs() const override {
    return {{{"interface", &fields::contact_force, Access::read},
             {"interface", &fields::mean_contact_force, Access::write}},
            {}};
  }
  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& interface = world.set("interface");
    const double share = world.clock.solid_share_of_mean();
    const auto& force = interface.vector(fields::contact_force);
    auto& mean = interface.vector(fields::mean_contact_force);
    parallel_for(interface.size(), [&](Index i) { mean[i] += share * (force[i] - mean[i]); });
  }
};

const RegisterEffect<MeanContact> registered_mean_contact;

}  // namespace
}  // namespace sphgeo
