#include "core/parallel.h"
#include "effects/interface.h"

namespace sphgeo {
namespace {

/// Transfers the forces of water and soil from the interface to the solids, where they act through
/// all steps of solids in the acoustic step. Their means over the advection step are what a probe
/// shows: each rearrangement shakes the pressure, the steps after it calm it down, and the last of
/// them alone is some percent off the force that moved the body.
template <int Dim>
class SolidLoad final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_load", Stage::force, "Eq. 65, F^rs",
            "transfers the forces of water and soil on their surface to the solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    const bool water = world.find("water"),
               soil = world.find("soil") && world.parameters().soil.deformable;
    if (!world.find("interface") || (!water && !soil)) return {"no solid is in water or soil"};
    return {std::make_unique<SolidLoad>(solid_sets(world), water, soil),
            "there are solids in water or soil"};
  }

  SolidLoad(std::vector<std::string> solids, bool water, bool soil)
      : solids_(std::move(solids)), water_(water), soil_(soil) {}

  std::string acts_on() const override { return "solids"; }
  Needs needs() const override {
    Needs n;
    if (water_)
      n.fields.insert(n.fields.end(), {{"interface", &fields::water_force, Access::read},
                                       {"interface", &fields::mean_water_force, Access::update}});
    if (soil_)
      n.fields.insert(n.fields.end(), {{"interface", &fields::soil_force, Access::read},
                                       {"interface", &fields::mean_soil_force, Access::update}});
    for (const std::string& set : solids_)
      n.fields.push_back({set, &fields::fluid_force, Access::write});
    return n;
  }
  void apply(World<Dim>& world) override {
    map_.update(world);
    std::vector<Field<Vec<Dim>>*> force;
    for (const std::string& set : solids_) {
      force.push_back(&world.set(set).vector(fields::fluid_force));
      parallel_for(force.back()->size(), [&](Index i) { (*force.back())[i].setZero(); });
    }
    ParticleSet<Dim>& interface = world.set("interface");
    const auto& number = interface.tag(fields::source_set);
    const double share = share_of_mean(world.clock);
    const auto add = [&](const FieldSpec& field, const FieldSpec& mean_field) {
      const auto& by = interface.vector(field);
      auto& mean = interface.vector(mean_field);
      parallel_for(interface.size(), [&](Index s) {
        (*force[static_cast<std::size_t>(number[s])])[map_.at(s).i] += by[s];
        mean[s] += share * (by[s] - mean[s]);
      });
    };
    if (water_) add(fields::water_force, fields::mean_water_force);
    if (soil_) add(fields::soil_force, fields::mean_soil_force);
  }
  void save(StateSink& sink, const std::string& at) const override {
    sink.put_count(at + "step", step_);
    sink.put_number(at + "time", time_);
  }
  void load(const StateSource& source, const std::string& at) override {
    step_ = source.count(at + "step");
    time_ = source.number(at + "time");
  }
  std::size_t bytes() const override { return map_.bytes(); }

 private:
  /// Of this acoustic step in the time since the advection step began.
  double share_of_mean(const Clock& clock) {
    if (step_ != clock.advection_steps) time_ = 0;
    step_ = clock.advection_steps;
    time_ += clock.dt_acoustic;
    return clock.dt_acoustic / time_;
  }

  std::vector<std::string> solids_;
  bool water_, soil_;
  long step_ = 0;    ///< the advection step that the means are of
  double time_ = 0;  ///< that they are taken over, s
  InterfaceMap<Dim> map_;
};

const RegisterEffect<SolidLoad> registered_solid_load;

}  // namespace
}  // namespace sphgeo
