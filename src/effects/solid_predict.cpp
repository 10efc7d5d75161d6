#include <optional>

#include "core/parallel.h"
#include "deck/motion.h"
#include "effects/piola_records.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Elastic solids at the middle of their step: positions, deformation (Eqs. 67, 99) and stress
/// (Eqs. 36 to 40). Clamped regions are where their motion takes them.
template <int Dim>
class SolidPredict final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_predict", Stage::solid_predict, "Eqs. 36-40, 67, 99",
            "positions, deformation and stress of elastic solids at the middle of their step",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidPredict>(world); }

  explicit SolidPredict(std::string set, bool viscous)
      : set_(std::move(set)), viscous_(viscous), deformation_(set_) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    Needs n{{{set_, &fields::velocity, Access::read},
             {set_, &fields::reference_position, Access::read},
             {set_, &fields::reference_volume, Access::read},
             {set_, &fields::reference_correction, Access::read},
             {set_, &fields::clamp, Access::read},
             {set_, &fields::position, Access::update}},
            {},
            {set_}};
    need_deformation<Dim>(n, set_);
    need_piola<Dim>(n, set_, Access::write);
    if (viscous_) n.record<Moved>(set_, Access::write);
    return n;
  }

  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    if (world.clock.solid_step == 0) deformation_.find_frames(world);
    move_and_pack(world, set);
    const SolidParameters& parts = world.parameters().solids;
    const auto& part = set.tag(fields::part);
    const auto& correction = set.tensor(fields::reference_correction);
    const auto& clamp = set.tag(fields::clamp);
    const bool at_face = clamps_at_face(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const PiolaPacking<Dim, T> pack(world, set_);
      deformation_.gather_gradients(world, [&](Index i, const Mat<Dim>& g) {
        const SolidPart& p = parts[part[i]];
        Mat<Dim> pb = Mat<Dim>::Zero();
        if (p.elastic && !(at_face && clamp[i] >= 0)) {
          const Mat3 grad = to_space_tensor<Dim>(g);
          // P = F S with F = R (I + g).
          const Mat3 s = second_piola(grad, law_of(p));
          pb = deformation_.frame(part[i]).rotation * to_scene_tensor<Dim>(s + grad * s) *
               to_matrix<Dim>(correction[i]);
        }
        pack(i, pb);
      });
    });
  }

 private:
  using Moved = packed::SolidMotion<Dim>;

  void move_and_pack(World<Dim>& world, ParticleSet<Dim>& set) {
    const double half = 0.5 * world.clock.dt_solid, middle = world.clock.solid_time() + half;
    auto& x = set.vector(fields::position);
    const auto& v = set.vector(fields::velocity);
    const auto& reference = set.vector(fields::reference_position);
    const auto& part = set.tag(fields::part);
    const auto& clamp = set.tag(fields::clamp);
    const SolidParameters& parts = world.parameters().solids;
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<packed::Displacement<Dim>, T>(world, set_);
      std::optional<RecordPacking<Moved, T>> motions;
      if (viscous_) motions = write_records<Moved, T>(world, set_);
      parallel_for(set.size(), [&](Index i) {
        if (!parts[part[i]].elastic) return;
        if (clamp[i] < 0) {
          x[i] += half * v[i];
        } else {
          const Motion* motion = parts[part[i]].clamped[static_cast<std::size_t>(clamp[i])].motion;
          x[i] = motion ? to_scene<Dim>(motion->position(to_space<Dim>(reference[i]), middle))
                        : reference[i];
        }
        deformation_.pack(records, i, x[i], reference[i], part[i]);
        if (!motions) return;
        (*motions)[i].put(Moved::displacement, x[i] - reference[i]);
        (*motions)[i].put(Moved::velocity, v[i]);
      });
    });
  }

  std::string set_;
  bool viscous_;
  Deformation<Dim> deformation_;  // its frames hold for one acoustic step
};

const RegisterEffect<SolidPredict> registered_solid_predict;

}  // namespace
}  // namespace sphgeo
