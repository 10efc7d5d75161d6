#include "core/parallel.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Stress, strain energy, volume and density of elastic solids in the current configuration, for
/// observers.
template <int Dim>
class SolidState final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_state", Stage::observe, "Eqs. 34, 36-40, 64, 67",
            "stress, strain energy and density of elastic solids at the time of a probe or frame",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidState>(world); }

  explicit SolidState(std::string set) : set_(std::move(set)), deformation_(set_) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    Needs n{{{set_, &fields::reference_position, Access::read},
             {set_, &fields::reference_volume, Access::read},
             {set_, &fields::reference_correction, Access::read},
             {set_, &fields::cauchy_stress, Access::write},
             {set_, &fields::von_mises, Access::write},
             {set_, &fields::strain_energy, Access::write},
             {set_, &fields::volume, Access::write}},
            {},
            {set_}};
    need_deformation<Dim>(n, set_);
    return n;
  }

  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    const SolidParameters& parts = world.parameters().solids;
    const auto& x = set.vector(fields::position);
    const auto& reference = set.vector(fields::reference_position);
    const auto& volume0 = set.scalar(fields::reference_volume);
    const auto& part = set.tag(fields::part);
    const auto& clamp = set.tag(fields::clamp);
    const bool at_face = clamps_at_face(world);
    auto& stress = set.tensor(fields::cauchy_stress);
    auto& von_mises = set.scalar(fields::von_mises);
    auto& energy = set.scalar(fields::strain_energy);
    auto& volume = set.scalar(fields::volume);
    deformation_.find_frames(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<packed::Displacement<Dim>, T>(world, set_);
      parallel_for(set.size(),
                   [&](Index i) { deformation_.pack(records, i, x[i], reference[i], part[i]); });
    });
    deformation_.gather_gradients(world, [&](Index i, const Mat<Dim>& g) {
      const SolidPart& p = parts[part[i]];
      stress[i].setZero();
      von_mises[i] = energy[i] = 0;
      volume[i] = volume0[i];
      if (!p.elastic || (at_face && clamp[i] >= 0)) return;
      const Mat3 grad = to_space_tensor<Dim>(g);
      const Mat3 f =
          to_space_tensor<Dim>(deformation_.frame(part[i]).rotation) * (Mat3::Identity() + grad) +
          out_of_plane();
      const double jacobian = 1 + volume_change(grad);
      const Mat3 s = f * second_piola(grad, law_of(p)) * f.transpose() / jacobian;
      stress[i] << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
      const Mat3 deviator = s - s.trace() / 3 * Mat3::Identity();
      von_mises[i] = std::sqrt(1.5) * deviator.norm();
      energy[i] = volume0[i] * strain_energy_density(grad, law_of(p));
      volume[i] = volume0[i] * jacobian;
    });
  }

 private:
  // The rotation of a plane scene leaves the third axis alone.
  static Mat3 out_of_plane() {
    Mat3 m = Mat3::Zero();
    if (Dim == 2) m(1, 1) = 1;
    return m;
  }

  std::string set_;
  Deformation<Dim> deformation_;
};

const RegisterEffect<SolidState> registered_solid_state;

}  // namespace
}  // namespace sphgeo
