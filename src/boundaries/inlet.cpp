#include <cmath>

#include "boundaries/exchange.h"
#include "deck/registry.h"

namespace sphgeo {

Schema<Inlet> Inlet::schema() {
  Schema<Inlet> s("inlet",
                  "a flat rectangle that emits layers of water with a prescribed velocity, into "
                  "air or along a wall: a jet, rain");
  s.required("min", &Inlet::min, unit::length, "one corner of the rectangle");
  s.required("max", &Inlet::max, unit::length,
             "the opposite corner; along one axis the two are the same. The flow is that of the "
             "nearest whole number of spacings along each side");
  s.required("velocity", &Inlet::velocity, unit::speed, "velocity of the water, formulas of t")
      .only_of("t");
  s.optional("share", &Inlet::share, unit::none,
             "fraction of the positions in a layer that get a particle, chosen at random: below 1 "
             "the inflow is rain of single drops")
      .above(0)
      .at_most(1);
  s.optional("seed", &Inlet::seed, unit::none, "another seed gives other drops").at_least(0);
  s.optional("from", &Inlet::from, unit::time, "closed before this time").at_least(0);
  s.optional("until", &Inlet::until, unit::time, "closed after this time");
  s.check([](Inlet& inlet, CheckContext& c) {
    int flat = 0;
    for (const int k : {0, 1, 2})
      if (!(c.dimension() == 2 && k == 1)) {
        flat += inlet.max[k] == inlet.min[k];
        if (inlet.max[k] < inlet.min[k]) return c.error("max", "max lies below min", "swap them");
      }
    if (flat != 1)
      return c.error("max", "an inlet is flat: min and max differ along all axes but one",
                     "give both the same coordinate along the direction of flow");
    const double across = inlet.velocity_at(inlet.from)[inlet.axis(c.dimension())];
    if (across == 0)
      c.error("velocity", "the velocity is parallel to the inlet when it opens",
              "give it a velocity along the axis in which min and max are the same");
    if (inlet.until && *inlet.until <= inlet.from)
      c.error("until", "the inlet closes before it opens", "");
  });
  return s;
}

int Inlet::axis(int dimension) const {
  for (const int k : {0, 1, 2})
    if (!(dimension == 2 && k == 1) && max[k] == min[k]) return k;
  return 2;
}

Vec3 Inlet::velocity_at(double time) const {
  const Vec3 nowhere = Vec3::Zero();
  return {velocity[0](nowhere, time), velocity[1](nowhere, time), velocity[2](nowhere, time)};
}

std::vector<Vec3> Inlet::layer(double spacing, int dimension) const {
  const int across = axis(dimension);
  Index n[3];
  for (const int k : {0, 1, 2})
    n[k] = k == across || (dimension == 2 && k == 1)
               ? 1
               : std::max<Index>(1, std::llround((max[k] - min[k]) / spacing));
  std::vector<Vec3> positions;
  for (Index z = 0; z < n[2]; ++z)
    for (Index y = 0; y < n[1]; ++y)
      for (Index x = 0; x < n[0]; ++x) {
        const Index at[3] = {x, y, z};
        Vec3 p = min;
        for (const int k : {0, 1, 2})
          if (k != across)
            p[k] = dimension == 2 && k == 1
                       ? 0
                       : min[k] + (static_cast<double>(at[k]) + 0.5) * (max[k] - min[k]) /
                                      static_cast<double>(n[k]);
        positions.push_back(p);
      }
  return positions;
}

Aabb Inlet::source_box() const {
  Aabb box;
  box.extend(min);
  box.extend(max);
  return box;
}

std::optional<double> Inlet::expected_particles(double spacing, int dimension, double start,
                                                double end) const {
  const double a = std::max(start, from), b = std::min(end, until.value_or(end));
  if (!(b > a)) return 0.0;
  constexpr int samples = 200;
  const int across = axis(dimension);
  double way = 0;
  for (int k = 0; k < samples; ++k)
    way += std::abs(velocity_at(a + (k + 0.5) * (b - a) / samples)[across]) * (b - a) / samples;
  return share * static_cast<double>(layer(spacing, dimension).size()) * way / spacing;
}

namespace {
const Register<BoundarySpec, Inlet> registered_inlet{"inlet"};
}
}  // namespace sphgeo
