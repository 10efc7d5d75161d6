#include "core/parallel.h"
#include "effects/quadratic_gradient.h"

namespace sphgeo {
namespace {

/// Upper half of sum of r (x) grad W at rest, by rows.
template <int Dim>
struct MomentSum {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T moment[Dim * (Dim + 1) / 2] = {};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, packed::Displacement<Dim>>&,
                  const Record<T, packed::Displacement<Dim>>&, const LaneVec<Dim, T>& r,
                  const T& r2) const {
    const T gradient = T(-1) * kernel.dw_over_r(r2);
    for (int k = 0, n = 0; k < Dim; ++k)
      for (int l = k; l < Dim; ++l, ++n) sum.moment[n] += gradient * r[k] * r[l];
  }
};

/// What follows from the positions of solids at rest, once: the correction B0 of the gradient (Eq.
/// 66) and the positions in the records.
template <int Dim>
class SolidCorrection final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_correction", Stage::reinitialize, "Eq. 66",
            "correction of the kernel gradient of solids at rest, once", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidCorrection>(world); }

  explicit SolidCorrection(std::string set) : set_(std::move(set)) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    Needs n{{{set_, &fields::reference_position, Access::read},
             {set_, &fields::reference_volume, Access::read},
             {set_, &fields::reference_correction, Access::write}},
            {},
            {set_}};
    n.record<Displacement>(set_, Access::write, Displacement::position);
    n.record<Piola>(set_, Access::write, Piola::position);
    return n;
  }

  void apply(World<Dim>& world) override {
    if (done_) return;
    place(world);
    const ParticleSet<Dim>& set = world.set(set_);
    const auto& volume = set.scalar(fields::reference_volume);
    auto& correction = world.set(set_).tensor(fields::reference_correction);
    const MomentSum<Dim> pair{Kernel<Dim>(set.smoothing_length())};
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = read_records<Displacement, T>(world, set_);
      gather<MomentSum<Dim>::template Sums>(world.reference_list(set_), records, records, pair,
                                            [&](Index i, const auto& sum) {
                                              double moment[Dim * (Dim + 1) / 2];
                                              for (std::size_t n = 0; n < std::size(moment); ++n)
                                                moment[n] = volume[i] * sum.moment[n];
                                              const InverseMoment<Dim, double> inverse(moment);
                                              Sym3 b = Sym3::Zero();
                                              b[1] = 1;
                                              for (int k = 0; k < Dim; ++k)
                                                for (int l = k; l < Dim; ++l)
                                                  b[tensor_index<Dim>[k][l]] = inverse.entry[k][l];
                                              correction[i] = b;
                                            });
    });
    if (world.parameters().numerics.solid_gradient == SolidGradient::quadratic)
      world.reference_weights(set_) = quadratic_weights(world, set_);
  }
  void restore(World<Dim>& world) override {
    place(world);
    if (world.parameters().numerics.solid_gradient == SolidGradient::quadratic)
      world.reference_weights(set_) = quadratic_weights(world, set_);
  }

 private:
  using Displacement = packed::Displacement<Dim>;
  using Piola = packed::Piola<Dim>;

  void place(World<Dim>& world) {
    done_ = true;
    const ParticleSet<Dim>& set = world.set(set_);
    const auto& at_rest = set.vector(fields::reference_position);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto displacements = write_records<Displacement, T>(world, set_);
      const auto stresses = write_records<Piola, T>(world, set_);
      parallel_for(set.size(), [&](Index i) {
        displacements.set_position(i, at_rest[i]);
        stresses.set_position(i, at_rest[i]);
      });
    });
  }

  std::string set_;
  bool done_ = false;
};

const RegisterEffect<SolidCorrection> registered_solid_correction;

}  // namespace
}  // namespace sphgeo
