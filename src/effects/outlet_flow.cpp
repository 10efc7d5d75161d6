#include "core/indices_where.h"
#include "core/parallel.h"
#include "deck/interfaces.h"
#include "effects/exchange.h"

namespace sphgeo {
namespace {

/// Particles that are taken out where they have come into an outlet.
template <int Dim>
class OutletFlow final : public Effect<Dim> {
 public:
  explicit OutletFlow(const OutletParameters& outlet) : outlet_(outlet) {}
  static EffectInfo info() {
    return {"outlet_flow", Stage::exchange, "5.1, 6.1", "particles that leave through an outlet",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_exchange<OutletFlow, Dim>(world.parameters().outlets, "an outlet");
  }

  std::string acts_on() const override { return "outlet '" + outlet_.name + "'"; }
  Needs needs() const override { return {}; }

  void prepare(World<Dim>& world) override {
    world.exchanged(outlet_.name);
    box_ = outlet_.shape->box();
  }

  void apply(World<Dim>& world) override {
    Exchanged<Dim>& account = world.exchanged(outlet_.name);
    for (const std::string& name : outlet_.sets) {
      ParticleSet<Dim>* set = world.find(name);
      if (set == nullptr) continue;
      const auto& x = set->vector(fields::position);
      const auto inside = [&](Index i) {
        const Vec3 at = to_space<Dim>(x[i]);
        return box_.contains(at) && outlet_.shape->signed_distance(at) < 0;
      };
      std::vector<char> leaves(static_cast<std::size_t>(set->size()));
      parallel_for(set->size(), [&](Index i) { leaves[static_cast<std::size_t>(i)] = inside(i); });
      const auto gone = indices_where(
          set->size(), [&](Index i) { return leaves[static_cast<std::size_t>(i)] != 0; });
      if (gone.empty()) continue;
      for (const std::uint32_t i : gone) {
        account.left += 1;
        account.add(-1, set->scalar(fields::mass)[i], x[i], set->vector(fields::velocity)[i],
                    world.gravity());
      }
      set->permute(indices_where(
          set->size(), [&](Index i) { return leaves[static_cast<std::size_t>(i)] == 0; }));
    }
  }

 private:
  const OutletParameters& outlet_;
  Aabb box_;
};

const RegisterEffect<OutletFlow> registered_outlet_flow;

}  // namespace
}  // namespace sphgeo
