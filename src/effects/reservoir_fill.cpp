#include <array>
#include <cmath>
#include <map>

#include "effects/exchange.h"

namespace sphgeo {
namespace {

/// Water that is added where the surface has sunk by nearly a spacing: at a position of the layer
/// below the level that has no water, soil or wall within 0.9 spacings. It takes the mean velocity
/// of the water within two spacings.
template <int Dim>
class ReservoirFill final : public Effect<Dim> {
 public:
  explicit ReservoirFill(const ReservoirParameters& reservoir) : reservoir_(reservoir) {}
  static EffectInfo info() {
    return {"reservoir_fill", Stage::exchange, "5.1",
            "water added where a surface sinks below the level of a reservoir", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_exchange<ReservoirFill, Dim>(world.parameters().reservoirs, "a reservoir");
  }

  std::string acts_on() const override { return "water, reservoir '" + reservoir_.name + "'"; }
  Needs needs() const override {
    return {{{"water", &fields::position, Access::update},
             {"water", &fields::velocity, Access::update},
             {"water", &fields::density, Access::update}},
            {}};
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    world.exchanged(reservoir_.name);
    positions_.clear();
    for (const Vec3& p : reservoir_.positions) positions_.push_back(to_scene<Dim>(p));
  }

  void apply(World<Dim>& world) override {
    const double dp = water_->spacing(), reach = 2 * dp;
    std::vector<char> taken(positions_.size(), 0);
    std::vector<double> weight(positions_.size(), 0);
    std::vector<Vec<Dim>> velocity(positions_.size(), Vec<Dim>::Zero());
    for (const auto& set : world.sets()) {
      const bool water = set.get() == water_;
      const auto& x = set->vector(fields::position);
      for_near(x, set->size(), reach, [&](Index i, std::size_t p) {
        const double distance = (x[i] - positions_[p]).norm();
        if (distance < 0.9 * dp) taken[p] = 1;
        if (!water || distance > reach) return;
        weight[p] += 1;
        velocity[p] += water_->vector(fields::velocity)[i];
      });
    }
    std::vector<InsertedParticle<Dim>> inserted;
    for (std::size_t p = 0; p < positions_.size(); ++p)
      if (!taken[p])
        inserted.push_back({positions_[p], weight[p] > 0 ? Vec<Dim>(velocity[p] / weight[p])
                                                         : Vec<Dim>(Vec<Dim>::Zero())});
    insert_particles(world, *water_, reservoir_.name, inserted);
  }

  std::size_t bytes() const override { return positions_.size() * sizeof(Vec<Dim>); }

 private:
  using Cell = std::array<Index, Dim>;

  /// Calls f(i, p) for the particles and positions that may be within reach, particle by particle.
  template <class F>
  void for_near(const Field<Vec<Dim>>& x, Index n, double reach, F&& f) {
    const auto cell_of = [&](const Vec<Dim>& at) {
      Cell c;
      for (int d = 0; d < Dim; ++d)
        c[static_cast<std::size_t>(d)] = static_cast<Index>(std::floor(at[d] / reach));
      return c;
    };
    if (cells_.empty())
      for (std::size_t p = 0; p < positions_.size(); ++p) {
        cells_[cell_of(positions_[p])].push_back(p);
        lo_ = p == 0 ? positions_[p] : Vec<Dim>(lo_.cwiseMin(positions_[p]));
        hi_ = p == 0 ? positions_[p] : Vec<Dim>(hi_.cwiseMax(positions_[p]));
      }
    for (Index i = 0; i < n; ++i) {
      if (!((x[i].array() >= lo_.array() - reach).all() &&
            (x[i].array() <= hi_.array() + reach).all()))
        continue;
      const Cell middle = cell_of(x[i]);
      Cell c;
      visit(0, middle, c, [&] {
        const auto at = cells_.find(c);
        if (at == cells_.end()) return;
        for (const std::size_t p : at->second) f(i, p);
      });
    }
  }

  template <class F>
  void visit(int axis, const Cell& middle, Cell& c, F&& f) {
    if (axis == Dim) return f();
    const auto d = static_cast<std::size_t>(axis);
    for (const Index step : {-1, 0, 1}) {
      c[d] = middle[d] + step;
      visit(axis + 1, middle, c, f);
    }
  }

  const ReservoirParameters& reservoir_;
  std::vector<Vec<Dim>> positions_;
  std::map<Cell, std::vector<std::size_t>> cells_;
  Vec<Dim> lo_ = Vec<Dim>::Zero(), hi_ = Vec<Dim>::Zero();
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<ReservoirFill> registered_reservoir_fill;

}  // namespace
}  // namespace sphgeo
