#pragma once
// Access of probes to a running world.

#include "probes/scene_view.h"
#include "sph/kernel.h"
#include "sph/world.h"

namespace sphgeo {

/// Valid until the world is rearranged.
template <int Dim>
class WorldView final : public SceneView {
 public:
  /// The model is the one that the world was built from.
  WorldView(const Model& model, const World<Dim>& world) : model_(model), world_(world) {}

  const Model& model() const override { return model_; }
  const Parameters& parameters() const override { return world_.parameters(); }
  double time() const override { return world_.clock.time; }
  bool has_set(const std::string& set) const override { return world_.find(set) != nullptr; }
  bool has_field(const std::string& set, const FieldSpec& field) const override {
    return has_set(set) && world_.set(set).has(field);
  }
  Index size(const std::string& set) const override { return world_.set(set).size(); }
  double spacing(const std::string& set) const override { return world_.set(set).spacing(); }
  double smoothing_length(const std::string& set) const override {
    return world_.set(set).smoothing_length();
  }
  std::function<double(Index)> scalar(const std::string& set,
                                      const FieldSpec& field) const override {
    return [&f = world_.set(set).scalar(field)](Index i) { return f[i]; };
  }
  std::function<Vec3(Index)> vector(const std::string& set, const FieldSpec& field) const override {
    return [&f = world_.set(set).vector(field)](Index i) { return to_space<Dim>(f[i]); };
  }
  std::function<Sym3(Index)> tensor(const std::string& set, const FieldSpec& field) const override {
    return [&f = world_.set(set).tensor(field)](Index i) -> Sym3 { return f[i]; };
  }
  std::function<std::int32_t(Index)> tag(const std::string& set,
                                         const FieldSpec& field) const override {
    return [&f = world_.set(set).tag(field)](Index i) { return f[i]; };
  }
  void near(const std::string& set, const Vec3& at,
            const std::function<void(Index, double)>& f) const override {
    const ParticleSet<Dim>& s = world_.set(set);
    const Kernel<Dim> kernel(s.smoothing_length());
    const auto& x = s.vector(fields::position);
    const Vec<Dim> point = to_scene<Dim>(at);
    // The grid is that of the last rearrangement, before the transport displacement.
    world_.grid(set).for_each_in_reach(point, kernel.support() + 0.5 * s.spacing(),
                                       [&](Index i, double) {
                                         const double w = kernel.w((x[i] - point).squaredNorm());
                                         if (w > 0) f(i, w);
                                       });
  }
  Crossings crossings(const std::string& boundary) const override {
    const auto at = world_.exchanged().find(boundary);
    return at == world_.exchanged().end()
               ? Crossings{}
               : Crossings{at->second.entered, at->second.left, at->second.mass};
  }
  Aabb domain() const override {
    return {to_space<Dim>(world_.domain_lo()), to_space<Dim>(world_.domain_hi())};
  }

 private:
  const Model& model_;
  const World<Dim>& world_;
};

}  // namespace sphgeo
