#include <cmath>

#include "core/hash.h"
#include "deck/expression.h"
#include "effects/exchange.h"

namespace sphgeo {
namespace {

/// Water that enters in layers: one for every spacing that it has come through the inlet.
template <int Dim>
class InletFlow final : public Effect<Dim> {
 public:
  explicit InletFlow(const InletParameters& inlet) : inlet_(inlet) {}
  static EffectInfo info() {
    return {"inlet_flow", Stage::exchange, "5.1, 6.1",
            "layers of water that enter through an inlet", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_exchange<InletFlow, Dim>(world.parameters().inlets, "an inlet");
  }

  std::string acts_on() const override { return "water, inlet '" + inlet_.name + "'"; }
  Needs needs() const override {
    return {{{"water", &fields::position, Access::update},
             {"water", &fields::velocity, Access::update},
             {"water", &fields::density, Access::update}},
            {}};
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    world.exchanged(inlet_.name);
  }

  void apply(World<Dim>& world) override {
    const double begin = std::max(last_, inlet_.from),
                 now = std::min(world.clock.time, inlet_.until.value_or(world.clock.time));
    last_ = std::max(last_, world.clock.time);
    if (world.clock.time < inlet_.from || now < begin) return;
    // The velocity at the middle of the interval is good to the second order; a step is a small
    // part of what it takes to change.
    const Vec3 velocity = velocity_at(0.5 * (begin + now));
    const double dp = water_->spacing(),
                 speed = std::max(0.0, inlet_.direction * velocity[inlet_.across]);
    distance_ += speed * (now - begin);
    std::vector<InsertedParticle<Dim>> inserted;
    // A layer enters when half of it has come through, so that what has entered is the distance to
    // half a layer.
    for (; (layers_ + 0.5) * dp <= distance_; ++layers_) {
      // Since it came through; no longer ago than the last step.
      const double ago =
          speed > 0 ? std::min((distance_ - (layers_ + 0.5) * dp) / speed, now - begin) : 0;
      const Vec3 ahead = ago * velocity;
      for (std::size_t k = 0; k < inlet_.layer.size(); ++k) {
        const auto number = static_cast<std::uint64_t>(layers_) * inlet_.layer.size() + k;
        if (inlet_.share < 1 && random_uniform(inlet_.seed, number) >= inlet_.share) continue;
        inserted.push_back({to_scene<Dim>(inlet_.layer[k] + ahead), to_scene<Dim>(velocity)});
      }
    }
    insert_particles(world, *water_, inlet_.name, inserted);
  }

  void save(StateSink& sink, const std::string& at) const override {
    sink.put_number(at + "distance", distance_);
    sink.put_number(at + "layers", layers_);
    sink.put_number(at + "time", last_);
  }
  void load(const StateSource& source, const std::string& at) override {
    distance_ = source.number(at + "distance");
    layers_ = source.number(at + "layers");
    last_ = source.number(at + "time");
  }
  std::size_t bytes() const override { return inlet_.layer.size() * sizeof(Vec3); }

 private:
  Vec3 velocity_at(double time) const {
    const VectorFormula& v = *inlet_.velocity;
    const Vec3 nowhere = Vec3::Zero();
    return {v[0](nowhere, time), v[1](nowhere, time), v[2](nowhere, time)};
  }
  const InletParameters& inlet_;
  double distance_ = 0;  ///< that the water has come through, m
  double layers_ = 0;    ///< that have entered
  double last_ = 0;      ///< time of the last call, s
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<InletFlow> registered_inlet_flow;

}  // namespace
}  // namespace sphgeo
