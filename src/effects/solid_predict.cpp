#include "core/parallel.h"
#include "deck/motion.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Elastic solids at the middle of their step: places, deformation (Eqs. 67, 99) and stress (Eqs.
/// 36 to 40). Clamped regions are where their motion takes them.
template <int Dim>
class SolidPredict final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_predict", Stage::solid_predict, "Eqs. 36-40, 67, 99",
            "places, deformation and stress of elastic solids at the middle of their step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidPredict>(world); }

  explicit SolidPredict(std::string set) : set_(std::move(set)), deformation_(set_) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    return {{{set_, &fields::velocity, Access::read},
             {set_, &fields::reference_position, Access::read},
             {set_, &fields::reference_volume, Access::read},
             {set_, &fields::reference_correction, Access::read},
             {set_, &fields::clamp, Access::read},
             {set_, &fields::position, Access::update}},
            {},
            {set_}};
  }

  void prepare(World<Dim>& world) override { viscous_ = viscous_solids(world, set_); }

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
      T* record[2] = {world.records(set_, 1).template get<T>()[0], nullptr};
      if constexpr (Dim == 3) record[1] = world.records(set_, 2).template get<T>()[0];
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
        for (int k = 0; k < Dim * Dim; ++k) {
          const int slot = solid_slot::piola<Dim>(k);
          record[slot / record_size][i * record_size + slot % record_size] =
              static_cast<T>(pb(k / Dim, k % Dim));
        }
      });
    });
  }

 private:
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
      auto& records = world.records(set_, 0).template get<T>();
      auto* motion_records =
          viscous_ ? &world.records(set_, 1 + solid_slot::stress_records_of_solids<Dim>)
                          .template get<T>()
                   : nullptr;
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
        if (!motion_records) return;
        T* slot = (*motion_records)[i];
        for (int k = 0; k < Dim; ++k) {
          slot[k] = static_cast<T>(x[i][k] - reference[i][k]);
          slot[3 + k] = static_cast<T>(v[i][k]);
        }
      });
    });
  }

  std::string set_;
  bool viscous_ = false;
  Deformation<Dim> deformation_;  // its frames hold for one acoustic step
};

const RegisterEffect<SolidPredict> registered_solid_predict;

}  // namespace
}  // namespace sphgeo
