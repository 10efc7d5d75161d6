#include "scene/leak.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/flood.h"
#include "scene/shadow.h"

namespace sphgeo {
namespace {

// A grid this large takes some seconds and half a gigabyte.
constexpr double most_cells = 2e8;
// Pools smaller than this share of the largest are spray.
constexpr double small_pool = 0.01;

constexpr double inf = std::numeric_limits<double>::infinity();

/// All particles of a scene, by their role in a leak.
struct Parts {
  struct Solid {
    Vec3 at;
    std::int32_t boundary;  ///< -1: of a body
  };
  struct Lid {
    Vec3 at;
    std::int32_t boundary;
    std::string face;
  };
  std::vector<Solid> solids;
  std::vector<Lid> lids;
};

template <int Dim>
Parts parts_of(const Scene<Dim>& scene, const Model& model, int up, bool up_is_high) {
  Parts parts;
  for (const auto& s : scene.world->sets()) {
    if ((s->phase() != "wall" && s->phase() != "solid") || s->name() == "interface")
      continue;  // interface particles lie on their solids
    const auto& x = s->vector(fields::position);
    const auto& part = s->tag(fields::part);
    for (Index i = 0; i < s->size(); ++i)
      parts.solids.push_back({to_space<Dim>(x[i]), s->phase() == "wall" ? part[i] : -1});
  }
  const Placement placement{model.resolution, support_radius(model), Dim};
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* found = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    if (found == nullptr) continue;
    const WallBoundary& wall = *found;
    for (const OpenFace& face : wall.open_faces(placement)) {
      if (face.axis == up && face.high == up_is_high)
        continue;  // liquid may enter there, and never leaves
      for (const Vec3& p : face.points)
        parts.lids.push_back({wall.motion ? wall.motion->position(p, 0) : p,
                              static_cast<std::int32_t>(b), face.name});
    }
  }
  return parts;
}

std::string where(const Vec3& p, int dimension) {
  return dimension == 2 ? fmt::format("x = {:.4g}, z = {:.4g} m", p.x(), p.z())
                        : fmt::format("x = {:.4g}, y = {:.4g}, z = {:.4g} m", p.x(), p.y(), p.z());
}

/// The particles of one pool.
struct Pool {
  std::vector<Vec3> at;
  int index = -1;
  std::int32_t body = -1;  ///< of its first particle
};

/// The floods of one liquid set through one scene.
class LeakSearch {
 public:
  LeakSearch(const Model& model, const Parts& parts, const FloodFrame& frame, bool upright,
             Diagnostics& found)
      : model_(model),
        parts_(parts),
        frame_(frame),
        upright_(upright),
        found_(found),
        grid_(frame) {
    Aabb all = frame.box;
    for (const auto& s : parts.solids) all.extend(s.at);
    for (const auto& l : parts.lids) all.extend(l.at);
    for (int k = 0; k < 3; ++k) shadows_.emplace_back(k, frame.spacing, all);
    const auto add = [&](const Vec3& at) {
      for (Shadow& s : shadows_) s.add(at);
    };
    for (const auto& s : parts.solids) {
      grid_.add_solid(s.at);
      add(s.at);
    }
    for (const auto& l : parts.lids) {
      grid_.add_lid(l.at);
      add(l.at);
    }
  }

  void run(const std::vector<Vec3>& liquid, const std::vector<std::int32_t>& body) {
    for (const Vec3& at : liquid) grid_.add_liquid(at);
    const auto cells = grid_.pools();
    std::vector<Pool> pools(cells.size());
    for (std::size_t i = 0; i < liquid.size(); ++i) {
      const int k = grid_.pool_at(liquid[i], 0.5 * frame_.spacing);
      if (k < 0) continue;
      Pool& p = pools[static_cast<std::size_t>(k)];
      p.index = k;
      if (p.body < 0) p.body = body[i];
      p.at.push_back(liquid[i]);
    }
    for (std::size_t k = 0; k < pools.size(); ++k)
      if (pools[k].body >= 0 && cells[k].size() >= small_pool * cells[0].size())
        judge(pools[k], cells[k]);
  }

 private:
  // Least share of the pool that has a wall beside it, of all sideways directions.
  double enclosed(const Pool& pool) const {
    double least = 1;
    for (int a = 0; a < 3; ++a)
      for (const bool high : {false, true}) {
        if (a == frame_.up || (a == 1 && frame_.dimension == 2)) continue;
        const auto n = std::count_if(pool.at.begin(), pool.at.end(), [&](const Vec3& p) {
          return shadows_[static_cast<std::size_t>(a)].beyond(p, high);
        });
        least = std::min(least, static_cast<double>(n) / static_cast<double>(pool.at.size()));
      }
    return least;
  }
  bool wall_above(const Vec3& p) const {
    return shadows_[static_cast<std::size_t>(frame_.up)].beyond(p, frame_.up_is_high);
  }
  bool wall_below(const Vec3& p) const {
    return shadows_[static_cast<std::size_t>(frame_.up)].beyond(p, !frame_.up_is_high);
  }

  void judge(const Pool& pool, const FloodGrid::Cells& cells) {
    const double least = enclosed(pool);
    if (least < 0.5) return;
    int top = 0;
    for (const auto c : cells) top = std::max(top, grid_.layer(c));
    if (!grid_.escapes(cells, top)) {
      if (touched_lid(pool.index) == nullptr) return;
      grid_.ignore_lids(true);
      const bool runs_out = grid_.escapes(cells, top);
      grid_.ignore_lids(false);
      if (runs_out) note_open_face(pool);
      return;
    }
    const Index volume = static_cast<Index>(pool.at.size()) << frame_.dimension;
    const auto spill = grid_.spill_layer(cells, volume, top);
    const auto path = grid_.widest_path(cells, spill.value_or(top));
    if (path.empty()) return;
    const std::size_t k = narrowest(path);
    const bool roofed = wall_above(path[k].at);
    if (spill) {
      // Over a rim, or through a slit open at the top: only when walls surround the pool, so that a
      // weir or a low wall is not reported.
      if (!roofed && !path[k].down && (least < 0.9 || !upright_)) return;
    } else {
      // It would come to rest inside, but a splash reaches a hole. It is a leak if it falls out of
      // the scene from there.
      const Vec3& beyond = path[std::min(k + 8, path.size() - 1)].at;
      if (!roofed || wall_below(beyond)) return;
    }
    report(pool, path[k].at);
  }

  // The middle of the narrowest part of the path.
  static std::size_t narrowest(const std::vector<FloodGrid::Step>& path) {
    int least = path[0].clearance;
    for (const auto& s : path) least = std::min(least, s.clearance);
    std::size_t first = 0;
    while (path[first].clearance != least) ++first;
    std::size_t last = first;
    while (last + 1 < path.size() && path[last + 1].clearance == least) ++last;
    return (first + last) / 2;
  }

  // The solid particle nearest to a position, in the maximum norm as in the grid, and its boundary.
  std::pair<double, std::int32_t> nearest_solid(const Vec3& at) const {
    double nearest = inf;
    std::int32_t boundary = -1;
    for (const auto& s : parts_.solids) {
      Vec3 d = s.at - at;
      if (frame_.dimension == 2) d.y() = 0;
      const double r = d.cwiseAbs().maxCoeff();
      if (r < nearest) {
        nearest = r;
        boundary = s.boundary;
      }
    }
    return {nearest, boundary};
  }

  void report(const Pool& pool, Vec3 hole) {
    auto [nearest, boundary] = nearest_solid(hole);
    // From the cell to the middle of the gap, which lies less than a spacing away.
    for (double step = 0.25 * frame_.spacing; step > 0.03 * frame_.spacing; step /= 2)
      for (int k = 0; k < 3; ++k)
        for (const double by : {-step, step}) {
          if (k == 1 && frame_.dimension == 2) continue;
          Vec3 next = hole;
          next[k] += by;
          const auto [r, b] = nearest_solid(next);
          if (r > nearest + 1e-6 * frame_.spacing) {
            hole = next;
            nearest = r;
            boundary = b;
          }
        }
    hole = (hole.array().abs() < 1e-6 * frame_.spacing).select(0.0, hole);
    const Body& body = model_.bodies[static_cast<std::size_t>(pool.body)];
    const std::string near =
        boundary < 0 ? "a solid body"
                     : fmt::format("boundary '{}'",
                                   model_.boundaries[static_cast<std::size_t>(boundary)]->name);
    const std::string path = boundary < 0 ? fmt::format("bodies[{}].shape", pool.body)
                                          : fmt::format("boundaries[{}]", boundary);
    found_.warning(
        "W125", model_.place_of(path), path,
        fmt::format("body '{}' can run out of its container at {}, through an opening about {:.2g} "
                    "m ({:.2g} spacings) wide; nearest is {}",
                    body.name, where(hole, frame_.dimension),
                    std::max(0.0, 2 * nearest - frame_.spacing),
                    std::max(0.0, 2 * nearest / frame_.spacing - 1), near),
        "close the walls there or let them overlap; no change is needed if the opening is "
        "intended");
  }

  // A point of an open face that the pool starts at, and no other wall closes. Pools touch no other
  // pool's cells, so the first one found near a point is this pool or another one.
  const Parts::Lid* touched_lid(int pool) const {
    for (const auto& l : parts_.lids)
      if (!grid_.solid_at(l.at) && grid_.pool_at(l.at, 0.8 * frame_.spacing) == pool) return &l;
    return nullptr;
  }

  void note_open_face(const Pool& pool) {
    const Parts::Lid* lid = touched_lid(pool.index);
    const std::string path = fmt::format("boundaries[{}].open", lid->boundary);
    found_.add(
        {Severity::note, "N126", model_.place_of(path), path,
         fmt::format("body '{}' touches the open face '{}' of '{}' at t = 0 and flows out there",
                     model_.bodies[static_cast<std::size_t>(pool.body)].name, lid->face,
                     model_.boundaries[static_cast<std::size_t>(lid->boundary)]->name),
         ""});
  }

  const Model& model_;
  const Parts& parts_;
  FloodFrame frame_;
  bool upright_;  // gravity along an axis: heights are levels of still water
  Diagnostics& found_;
  FloodGrid grid_;
  std::vector<Shadow> shadows_;
};

}  // namespace

template <int Dim>
void check_leaks(const Scene<Dim>& scene, Diagnostics& found) {
  const Model& model = *scene.model;
  const double g = model.gravity.norm();
  if (!(g > 0)) return;  // no direction of gravity
  FloodFrame frame{Dim, model.resolution, 0, false, {}};
  model.gravity.cwiseAbs().maxCoeff(&frame.up);
  if (Dim == 2 && frame.up == 1) return;
  frame.up_is_high = model.gravity[frame.up] < 0;
  const bool upright = std::abs(model.gravity[frame.up]) > 0.999 * g;
  const Parts parts = parts_of(scene, model, frame.up, frame.up_is_high);
  if (parts.solids.empty()) return;
  for (const auto& s : parts.solids) frame.box.extend(s.at);
  for (const auto& l : parts.lids) frame.box.extend(l.at);
  for (const auto& s : scene.world->sets()) {
    if (s->phase() != "water" && s->phase() != "soil") continue;
    const auto& x = s->vector(fields::position);
    const auto& part = s->tag(fields::part);
    std::vector<Vec3> liquid(static_cast<std::size_t>(s->size()));
    std::vector<std::int32_t> body(liquid.size());
    Aabb own;
    for (Index i = 0; i < s->size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      liquid[k] = to_space<Dim>(x[i]);
      body[k] = part[i];
      own.extend(liquid[k]);
    }
    if (own.empty()) continue;
    FloodFrame here = frame;
    here.box.extend(own);
    (frame.up_is_high ? here.box.hi : here.box.lo)[frame.up] =
        (frame.up_is_high ? own.hi : own.lo)[frame.up];
    if (const double cells = FloodGrid::size_of(here); cells > most_cells) {  // would take minutes
      found.add({Severity::note, "N127", model.place_of("resolution"), "resolution",
                 fmt::format("not checked whether '{}' can run out of its container: this would "
                             "take {:.2g} cells of half a spacing, more than {:g}",
                             s->name(), cells, most_cells),
                 "check with a coarser --set resolution=... to find gaps that are wide at that "
                 "resolution"});
      continue;
    }
    LeakSearch(model, parts, here, upright, found).run(liquid, body);
  }
}

template void check_leaks<2>(const Scene<2>&, Diagnostics&);
template void check_leaks<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
