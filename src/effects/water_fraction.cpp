#include <algorithm>
#include <array>

#include "effects/effect.h"
#include "effects/pore_water.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// What the soil around a water particle amounts to.
template <int Dim>
struct SoilAround {
  using Pore = packed::Pore<Dim>;
  using Soil = packed::SoilDrag<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T grains{};            ///< sum of omega W
    T presence{};          ///< sum of V W
    LaneVec<3, T> drag{};  ///< sum of omega W times the coefficients of the drag
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Pore>&, const Record<T, Soil>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    const T w = kernel.w(r2), grains = w * j[Pore::weight];
    sum.grains += grains;
    sum.presence += w * j[Soil::volume];
    for (int k = 0; k < 3; ++k) sum.drag[k] += grains * j.at(Soil::coefficients, k);
  }
};

/// The share of the kernel that lies in walls.
template <int Dim>
struct WallShare {
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T share{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Position<Dim>>&,
                  const Record<T, packed::Wall<Dim>>& j, const LaneVec<Dim, T>&,
                  const T& r2) const {
    sum.share += kernel.w(r2) * j[packed::Wall<Dim>::volume];
  }
};

/// sum of weight_j W.
template <int Dim>
struct WeightSum {
  using Pore = packed::Pore<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T weight{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Pore>&, const Record<T, Pore>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.weight += kernel.w(r2) * j[Pore::weight];
  }
};

/// sum of weight_j W times how far a unit impulse moves j.
template <int Dim>
struct MobilitySum {
  using Pore = packed::Pore<Dim>;
  using Soil = packed::SoilMobility<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T product{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Pore>&, const Record<T, Soil>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.product += kernel.w(r2) * j[Pore::weight] * j[Soil::per_mass];
  }
};

/// Once per advection step: the share of the volume that water can take (Eq. 56), and what the drag
/// needs of the soil around.
///
/// The sum is cut off at walls. Its missing part is taken to be like the rest: it is divided by the
/// share of the kernel that lies outside of walls, as if the soil were mirrored there.
template <int Dim>
class WaterFraction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_fraction", Stage::reinitialize, "Eq. 56",
            "share of the volume that soil leaves to the water, and the soil's share in the drag",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    return {std::make_unique<WaterFraction>(world), "there are water and soil"};
  }

  explicit WaterFraction(const World<Dim>& world)
      : walls_(wall_sets(world)), deformable_(world.parameters().soil.deformable) {}

  std::string acts_on() const override { return "water near soil"; }
  // The positions are those of before the transport shift, whose target volumes need this fraction:
  // they are not named here.
  Needs needs() const override {
    Needs n{{{"water", &fields::water_fraction, Access::write},
             {"water", &fields::soil_sum, Access::write},
             {"water", &fields::drag_linear, Access::write},
             {"water", &fields::drag_quadratic, Access::write},
             {"soil", &fields::volume_fraction, Access::read},
             {"soil", &fields::mass, Access::read}},
            {{"water", "soil"}}};
    need_wall_volumes<Dim>(n, "water", walls_);
    n.record<Position<Dim>>("water", Access::previous);  // before particles are shifted
    for (const char* set : {"water", "soil"}) n.record<Pore>(set, Access::write);
    n.record<packed::SoilDrag<Dim>>("soil", Access::scratch);
    if (deformable_) {
      n.fields.push_back({"water", &fields::inverse_soil_mass, Access::write});
      n.lists.push_back({"soil", "water"});
      n.record<packed::SoilMobility<Dim>>("soil", Access::scratch);
    }
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
    floor_ = world.parameters().numerics.water_fraction_floor;
  }

  void apply(World<Dim>& world) override {
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      pack_pairs<T>(world);
      pack_soil<T>(world);
      sum_soil<T>(world);
      if (deformable_) soil_masses<T>(world);
    });
  }

  void restore(World<Dim>& world) override {
    world.with_pair_precision([&](auto number) { pack_pairs<decltype(number)>(world); });
  }

  void tally(std::vector<Tally>& tallies) const override {
    tallies.push_back(
        {"water_fraction_floor", "1",
         "water particles at the floor of the water fraction, at the last rearrangement",
         at_floor()});
  }

 private:
  using Pore = packed::Pore<Dim>;

  double at_floor() const {
    const auto& n = water_->scalar(fields::water_fraction);
    return ordered_sum(water_->size(), [&](Index i) { return n[i] <= floor_ ? 1.0 : 0.0; });
  }

  // Positions and weights that pairs of water and soil keep for the whole advection step.
  template <class T>
  void pack_pairs(World<Dim>& world) {
    const auto soil = write_records<Pore, T>(world, "soil");
    const auto water = write_records<Pore, T>(world, "water");
    const SoilParameters& parts = world.parameters().soil;
    const auto& part = soil_->tag(fields::part);
    const auto& m = soil_->scalar(fields::mass);
    const auto& grains = water_->scalar(fields::soil_sum);
    const auto soil_at = world.arranged_positions("soil"),
               water_at = world.arranged_positions("water");
    parallel_for(soil_->size(), [&](Index k) {
      soil.set_position(k, soil_at[static_cast<std::size_t>(k)]);
      soil[k].put(Pore::weight, m[k] / parts[part[k]].grain_density);
    });
    for_targets(world.list("water", "soil"), [&](Index i) {
      water.set_position(i, water_at[static_cast<std::size_t>(i)]);
      water[i].put(Pore::weight, grains[i] > 0 ? 1 / grains[i] : 0);
    });
  }

  // What only the sums of this stage need.
  template <class T>
  void pack_soil(World<Dim>& world) {
    using Drag = packed::SoilDrag<Dim>;
    const auto soil = write_records<Drag, T>(world, "soil");
    const SoilParameters& parts = world.parameters().soil;
    const double g = world.gravity().norm(), rho0 = world.parameters().water.density,
                 eta = world.parameters().water.viscosity;
    const auto& part = soil_->tag(fields::part);
    const auto& m = soil_->scalar(fields::mass);
    const auto& n = soil_->scalar(fields::volume_fraction);
    std::vector<std::array<double, 3>>
        drag;  // by body: Eq. 29 times (n^w)^2, and the two terms of Eq. 31
    for (const SoilPart& p : parts.of) {
      drag.push_back({0, 0, 0});
      if (p.drag == DragLaw::darcy) drag.back()[0] = rho0 * g / p.hydraulic_conductivity;
      if (p.drag == DragLaw::ergun)
        drag.back() = {0, p.drag_viscous * eta / (p.grain_size * p.grain_size),
                       p.drag_inertial * rho0 / p.grain_size};
    }
    parallel_for(soil_->size(), [&](Index k) {
      const auto record = soil[k];
      for (int c = 0; c < 3; ++c)
        record.put(Drag::coefficients, c,
                   drag[static_cast<std::size_t>(part[k])][static_cast<std::size_t>(c)]);
      record.put(Drag::volume, m[k] / (parts[part[k]].grain_density * n[k]));
    });
  }

  template <class T>
  void sum_soil(World<Dim>& world) {
    const Kernel<Dim> kernel(water_->smoothing_length());
    const NeighborList& list = world.list("water", "soil");
    const auto water = write_records<Pore, T>(world, "water");
    const auto soil = read_records<packed::SoilDrag<Dim>, T>(world, "soil");
    auto& n = water_->scalar(fields::water_fraction);
    auto& grains = water_->scalar(fields::soil_sum);
    auto& linear = water_->scalar(fields::drag_linear);
    auto& quadratic = water_->scalar(fields::drag_quadratic);
    parallel_for(water_->size(), [&](Index i) {
      n[i] = 1;
      grains[i] = linear[i] = quadratic[i] = 0;
    });
    const Index blocks = static_cast<Index>(list.blocks().size());
    parallel_blocks(blocks, 1, [&](Index b, Index, Index) {
      // Water that no soil is near pays nothing for its walls.
      if (list.blocks()[static_cast<std::size_t>(b)].size() == 0) return;
      std::array<double, block_size> share{};
      for (const std::string& set : walls_)
        gather_block<WallShare<Dim>::template Sums>(
            world.list("water", set), b, read_records<Position<Dim>, T>(world, "water"),
            read_records<packed::Wall<Dim>, T>(world, set), WallShare<Dim>{kernel},
            [&](Index i, const auto& s) {
              share[static_cast<std::size_t>(i - b * block_size)] += s.share;
            });
      gather_block<SoilAround<Dim>::template Sums>(
          list, b, water, soil, SoilAround<Dim>{kernel}, [&](Index i, const auto& s) {
            const double inside =
                std::max(0.1, 1 - share[static_cast<std::size_t>(i - b * block_size)]);
            const double free = 1 - s.grains / inside;
            n[i] = std::max(floor_, free);
            grains[i] = s.grains;
            water[i].put(Pore::weight, s.grains > 0 ? 1 / s.grains : 0);
            if (!(s.grains > 0)) return;
            // The share of the volume that is soil, pores and all: Darcy's law itself does not fade
            // where the soil ends.
            const double presence = std::min(1.0, s.presence / inside);
            linear[i] =
                (n[i] * n[i] * presence * s.drag[0] + (1 - n[i]) * (1 - n[i]) / n[i] * s.drag[1]) /
                s.grains;
            quadratic[i] = (1 - n[i]) * s.drag[2] / s.grains;
          });
    });
  }

  // The mass of soil that an impulse on each water particle would move, were all of them given
  // impulses alike: an impulse J_l is spread by P_lk, so soil k gains P_lk J_l / m_k, and water i
  // sees sum_k P_ik of that.
  template <class T>
  void soil_masses(World<Dim>& world) {
    using Soil = packed::SoilMobility<Dim>;
    const Kernel<Dim> kernel(water_->smoothing_length());
    const SoilParameters& parts = world.parameters().soil;
    const auto& part = soil_->tag(fields::part);
    const auto& m = soil_->scalar(fields::mass);
    const auto weights = read_records<Pore, T>(world, "soil");
    const auto soil = write_records<Soil, T>(world, "soil");
    const auto water = read_records<Pore, T>(world, "water");
    auto& inverse = water_->scalar(fields::inverse_soil_mass);
    parallel_for(soil_->size(), [&](Index k) { soil[k].put(Soil::per_mass, 0); });
    gather<WeightSum<Dim>::template Sums>(
        world.list("soil", "water"), weights, water, WeightSum<Dim>{kernel},
        [&](Index k, const auto& s) {
          if (parts[part[k]].moves)
            soil[k].put(Soil::per_mass, weights.get(k, Pore::weight) * s.weight / m[k]);
        });
    const auto& grains = water_->scalar(fields::soil_sum);
    parallel_for(water_->size(), [&](Index i) { inverse[i] = 0; });
    gather<MobilitySum<Dim>::template Sums>(world.list("water", "soil"), water, soil,
                                            MobilitySum<Dim>{kernel}, [&](Index i, const auto& s) {
                                              if (grains[i] > 0) inverse[i] = s.product / grains[i];
                                            });
  }

  std::vector<std::string> walls_;  // sets of walls
  bool deformable_;
  double floor_ = 0;  // least n^w
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<WaterFraction> registered_water_fraction;

}  // namespace
}  // namespace sphgeo
