#include "core/parallel.h"
#include "effects/interface.h"
#include "effects/pack_walls.h"

namespace sphgeo {
namespace {

/// The surface of solids as water and soil see it: normals of the bodies as they are now, by F^-T n
/// (line 12 of Algorithm 2; Eq. 71 gives their direction at rest, here taken from the shape), and
/// what wall pairs need.
template <int Dim>
class InterfaceState final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"interface_state", Stage::reinitialize, "Algorithm 2 line 12, Eq. 71",
            "normals of solids as they are deformed now, for water and soil", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface")) return {"no solid can meet anything"};
    if (!world.find("water") && !world.find("soil"))
      return {"there is no water and no soil around the solids"};
    return {std::make_unique<InterfaceState>(world), "there are solids in water or soil"};
  }

  explicit InterfaceState(const World<Dim>& world) {
    const SolidParameters& parts = world.parameters().solids;
    for (const std::string& set : solid_sets(world)) {
      solids_.push_back(set);
      deformations_.emplace_back(set);
      bool elastic = false;
      for (std::size_t b = 0; b < parts.of.size(); ++b)
        elastic = elastic || (parts.of[b].elastic && parts.of[b].set == set);
      elastic_.push_back(elastic);
    }
  }

  std::string acts_on() const override { return "interface"; }
  Needs needs() const override {
    Needs n{{{"interface", &fields::volume, Access::write},
             {"interface", &fields::normal, Access::update}},
            {}};
    for (std::size_t k = 0; k < solids_.size(); ++k)
      if (elastic_[k]) {
        n.fields.push_back({solids_[k], &fields::reference_correction, Access::read});
        n.reference_lists.push_back(solids_[k]);
        need_deformation<Dim>(n, solids_[k]);
      }
    need_wall_packing<Dim>(n, "interface", Access::write);
    return n;
  }

  void apply(World<Dim>& world) override {
    map_.update(world);
    ParticleSet<Dim>& interface = world.set("interface");
    rows_.resize(solids_.size());
    for (std::size_t k = 0; k < solids_.size(); ++k)
      rows_[k].assign(static_cast<std::size_t>(world.set(solids_[k]).size()), -1);
    const auto& number = interface.tag(fields::source_set);
    parallel_for(interface.size(), [&](Index s) {
      rows_[static_cast<std::size_t>(number[s])][static_cast<std::size_t>(map_.at(s).i)] =
          static_cast<std::int32_t>(s);
    });
    for (std::size_t k = 0; k < solids_.size(); ++k) turn_normals(world, k);
    restore(world);
  }
  void restore(World<Dim>& world) override {
    ParticleSet<Dim>& interface = world.set("interface");
    auto& volume = interface.scalar(fields::volume);
    const auto& at_rest = interface.scalar(fields::reference_volume);
    parallel_for(interface.size(), [&](Index s) { volume[s] = at_rest[s]; });
    pack_walls(world, "interface");
  }
  std::size_t bytes() const override {
    std::size_t sum = map_.bytes();
    for (const auto& rows : rows_) sum += rows.capacity() * sizeof(std::int32_t);
    return sum;
  }

 private:
  void turn_normals(World<Dim>& world, std::size_t k) {
    const ParticleSet<Dim>& set = world.set(solids_[k]);
    Deformation<Dim>& deformation = deformations_[k];
    const auto& x = set.vector(fields::position);
    const auto& reference = set.vector(fields::reference_position);
    const auto& part = set.tag(fields::part);
    const SolidParameters& parts = world.parameters().solids;
    deformation.find_frames(world);
    ParticleSet<Dim>& interface = world.set("interface");
    auto& normal = interface.vector(fields::normal);
    const auto& at_rest = interface.vector(fields::reference_normal);
    const auto turn = [&](Index i, const Mat<Dim>& g) {
      const std::int32_t s = rows_[k][static_cast<std::size_t>(i)];
      if (s < 0) return;
      const Mat<Dim> f = Mat<Dim>::Identity() + g;
      const Vec<Dim> n = deformation.frame(part[i]).rotation * f.inverse().transpose() * at_rest[s];
      if (n.allFinite() && n.norm() > 0) normal[s] = n.normalized();
    };
    if (elastic_[k]) {
      world.with_pair_precision([&](auto number) {
        using T = decltype(number);
        const auto records = write_records<packed::Displacement<Dim>, T>(world, solids_[k]);
        parallel_for(set.size(),
                     [&](Index i) { deformation.pack(records, i, x[i], reference[i], part[i]); });
      });
      deformation.gather_gradients(world, turn);
    }
    // Rigid bodies are as turned as their frame.
    parallel_for(set.size(), [&](Index i) {
      if (!parts[part[i]].elastic) turn(i, Mat<Dim>::Zero());
    });
  }

  std::vector<std::string> solids_;
  std::vector<bool> elastic_;
  std::vector<Deformation<Dim>> deformations_;
  std::vector<std::vector<std::int32_t>>
      rows_;  // by set and particle: its row in the interface, -1 inside of the body
  InterfaceMap<Dim> map_;
};

const RegisterEffect<InterfaceState> registered_interface_state;

}  // namespace
}  // namespace sphgeo
