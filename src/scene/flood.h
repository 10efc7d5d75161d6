#pragma once
// Where a liquid can flow between the solid particles of a scene: a grid of half spacings and a
// flood fill of its free cells. The only physics is that it flows down first.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Extent and orientation of the grid.
struct FloodFrame {
  int dimension;    ///< 2: the x-z plane
  double spacing;   ///< dp, m; cells are half as wide
  int up;           ///< axis (0, 1, 2) along which liquid falls
  bool up_is_high;  ///< whether it falls towards smaller coordinates
  Aabb box;         ///< of everything that may stop the liquid, cut at the liquid's top, m
};

/// Cells of half a spacing. A solid particle closes the cells with centres in a cube of 0.73
/// spacings half-width around it: layers up to 1.46 spacings apart are closed, and a gap from which
/// one layer of particles is missing stays open wherever it lies on the grid.
class FloodGrid {
 public:
  using Cell = std::uint32_t;
  using Cells = std::vector<Cell>;

  /// Cells that such a grid would have.
  static double size_of(const FloodFrame& frame);
  explicit FloodGrid(const FloodFrame& frame);

  /// Closes the cells around a solid particle.
  void add_solid(const Vec3& at);
  /// Closes the cells around a point of a face that is open on purpose; see `ignore_lids`.
  void add_lid(const Vec3& at);
  /// Lets floods pass the lids (true) or stops them there.
  void ignore_lids(bool ignore) { lids_ = ignore ? 0 : lid; }
  /// Whether a solid closes a position: a point of an open face behind which another wall stands.
  bool solid_at(const Vec3& at) const;
  /// Marks the cells of a particle of the liquid as its own.
  void add_liquid(const Vec3& at);
  /// The liquid, cut into parts that do not touch each other, largest first, at most 200 of them.
  /// Call once, after all of it has been added.
  std::vector<Cells> pools();
  /// The pool (index into the result of `pools`) within `reach` (m) of a position along the axes,
  /// or -1.
  int pool_at(const Vec3& p, double reach) const;

  /// Whether the pool can reach the outside without rising above `top`, a layer.
  bool escapes(const Cells& pool, int top);
  /// Moves `volume` cells of the pool: down before sideways, sideways before up. The highest layer
  /// reached when some cells reach the outside; empty otherwise.
  std::optional<int> spill_layer(const Cells& pool, Index volume, int top);

  /// A step of a path to the outside.
  struct Step {
    Vec3 at;        ///< m
    int clearance;  ///< cells to the nearest solid
    bool down;      ///< whether the path goes down here
  };
  /// The path from the pool to the outside whose narrowest point is as wide as possible, without
  /// rising above `top`; empty when there is none.
  std::vector<Step> widest_path(const Cells& pool, int top);

  /// The layer of a cell, counted upwards.
  int layer(Cell c) const { return static_cast<int>(c / layer_); }
  int layers() const { return n_[2]; }

 private:
  enum Flag : std::uint8_t { solid = 1, lid = 2, edge = 4, seen = 8, liquid = 16 };

  Vec3 inner(const Vec3& p) const;  // axes in the order: two sideways ones, up
  Vec3 outer(const Vec3& q) const;
  Vec3 center(Cell c) const;
  template <class F>
  void for_cells(const Vec3& at, double reach, F&& f) const;
  bool closed(Cell c) const { return (state_[c] & (solid | lids_)) != 0; }
  void forget();
  void measure_clearance();

  FloodFrame frame_;
  double cell_;  // width, m
  Vec3 lo_;      // lower corner in inner axes
  int n_[3];
  std::uint32_t layer_;                 // cells of one layer
  std::vector<std::int64_t> sideways_;  // offsets to the neighbours in the same layer
  std::uint8_t lids_ = lid;
  std::vector<std::uint8_t> state_, clearance_;
  std::vector<std::uint8_t> pool_of_;  // 1 + index of the pool
  int measured_lids_ = -1;
};

}  // namespace sphgeo
