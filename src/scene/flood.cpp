#include "scene/flood.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace sphgeo {
namespace {

// In spacings; see the comment of the class. Below 0.75, for which a gap of two spacings between
// centres is at least one cell wide.
constexpr double closing = 0.73;
constexpr int most_pools = 200;
constexpr std::uint8_t far = 255;

// Steps of a path, stored for tracing it back.
enum From : std::uint8_t { start = 0, from_above = 250, from_below = 251 };

}  // namespace

Vec3 FloodGrid::inner(const Vec3& p) const {
  const int a = frame_.up == 0 ? 2 : 0, b = frame_.up == 1 ? 2 : 1;
  return {p[a], p[b], frame_.up_is_high ? p[frame_.up] : -p[frame_.up]};
}

Vec3 FloodGrid::outer(const Vec3& q) const {
  const int a = frame_.up == 0 ? 2 : 0, b = frame_.up == 1 ? 2 : 1;
  Vec3 p;
  p[a] = q[0];
  p[b] = q[1];
  p[frame_.up] = frame_.up_is_high ? q[2] : -q[2];
  if (frame_.dimension == 2) p.y() = 0;
  return p;
}

double FloodGrid::size_of(const FloodFrame& frame) {
  double cells = 1;
  for (int k = 0; k < 3; ++k)
    if (frame.dimension == 3 || k != 1)
      cells *= (frame.box.hi[k] - frame.box.lo[k]) / (0.5 * frame.spacing) + 9;
  return cells;
}

FloodGrid::FloodGrid(const FloodFrame& frame) : frame_(frame), cell_(0.5 * frame.spacing) {
  const Vec3 a = inner(frame.box.lo), b = inner(frame.box.hi);
  const Vec3 lo = a.cwiseMin(b), hi = a.cwiseMax(b);
  // Margin beyond the solids on all sides: cells there are outside.
  lo_ = lo.array() - 4 * cell_;
  for (int k = 0; k < 3; ++k)
    n_[k] = static_cast<int>(std::ceil((hi[k] - lo[k]) / cell_ - 1e-6)) + 8;
  if (frame.dimension == 2) {
    lo_[1] = -0.5 * cell_;
    n_[1] = 1;
  }
  layer_ = static_cast<std::uint32_t>(n_[0] * n_[1]);
  sideways_ = {-1, 1};
  if (n_[1] > 1) sideways_.insert(sideways_.end(), {-n_[0], n_[0]});
  state_.assign(static_cast<std::size_t>(layer_) * static_cast<std::size_t>(n_[2]), 0);
  parallel_for(static_cast<Index>(state_.size()), [&](Index cell) {
    const auto c = static_cast<std::size_t>(cell);
    const auto in_layer = static_cast<int>(c % layer_);
    const int i = in_layer % n_[0], j = in_layer / n_[0], k = static_cast<int>(c / layer_);
    if (k == n_[2] - 1) state_[c] = solid;  // no flood rises above the liquid's top
    else if (i == 0 || i == n_[0] - 1 || k == 0 || (n_[1] > 1 && (j == 0 || j == n_[1] - 1)))
      state_[c] = edge;
  });
}

Vec3 FloodGrid::center(Cell c) const {
  const auto in_layer = static_cast<int>(c % layer_);
  const Vec3 at(in_layer % n_[0] + 0.5, in_layer / n_[0] + 0.5, layer(c) + 0.5);
  return lo_ + cell_ * at;
}

// Calls f(cell) for the cells whose centres lie in the cube of half-width `reach`.
template <class F>
void FloodGrid::for_cells(const Vec3& at, double reach, F&& f) const {
  const Vec3 q = inner(at);
  int first[3], last[3];
  for (int k = 0; k < 3; ++k) {
    const double x = (q[k] - lo_[k]) / cell_ - 0.5, r = reach / cell_;
    first[k] = static_cast<int>(std::max(0.0, std::ceil(x - r)));
    last[k] = static_cast<int>(std::min(n_[k] - 1.0, std::floor(x + r)));
  }
  if (n_[1] == 1) first[1] = last[1] = 0;
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        f(static_cast<Cell>((static_cast<Index>(k) * n_[1] + j) * n_[0] + i));
}

void FloodGrid::add_solid(const Vec3& at) {
  for_cells(at, closing * frame_.spacing, [&](Cell c) { state_[c] |= solid; });
}

void FloodGrid::add_lid(const Vec3& at) {
  for_cells(at, closing * frame_.spacing, [&](Cell c) { state_[c] |= lid; });
}

bool FloodGrid::solid_at(const Vec3& at) const {
  bool all = true;
  for_cells(at, 0.5 * cell_, [&](Cell c) { all = all && (state_[c] & solid) != 0; });
  return all;
}

void FloodGrid::add_liquid(const Vec3& at) {
  for_cells(at, 0.5 * frame_.spacing, [&](Cell c) {
    if ((state_[c] & (solid | edge)) == 0) state_[c] |= liquid;
  });
}

std::vector<FloodGrid::Cells> FloodGrid::pools() {
  std::vector<Cells> found;
  forget();
  for (Cell first = 0; first < state_.size(); ++first) {
    if ((state_[first] & (liquid | seen)) != liquid) continue;
    Cells pool{first};
    state_[first] |= seen;
    for (std::size_t k = 0; k < pool.size(); ++k) {
      const auto visit = [&](std::int64_t c) {
        auto& s = state_[static_cast<std::size_t>(c)];
        if ((s & (liquid | seen)) != liquid) return;
        s |= seen;
        pool.push_back(static_cast<Cell>(c));
      };
      const std::int64_t c = pool[k];
      for (const std::int64_t by : sideways_) visit(c + by);
      visit(c - layer_);
      visit(c + layer_);
    }
    found.push_back(std::move(pool));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Cells& a, const Cells& b) { return a.size() > b.size(); });
  if (found.size() > most_pools) found.resize(most_pools);
  pool_of_.assign(state_.size(), 0);
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const Cell c : found[k]) pool_of_[c] = static_cast<std::uint8_t>(k + 1);
  return found;
}

int FloodGrid::pool_at(const Vec3& p, double reach) const {
  int pool = -1;
  for_cells(p, reach, [&](Cell c) {
    if (pool < 0 && pool_of_[c] > 0) pool = pool_of_[c] - 1;
  });
  return pool;
}

void FloodGrid::forget() {
  for (auto& s : state_) s &= static_cast<std::uint8_t>(~seen);
}

bool FloodGrid::escapes(const Cells& pool, int top) {
  forget();
  Cells queue;
  for (const Cell c : pool)
    if (!closed(c) && layer(c) <= top) {
      state_[c] |= seen;
      queue.push_back(c);
    }
  while (!queue.empty()) {
    const Cell c = queue.back();
    queue.pop_back();
    if (state_[c] & edge) return true;
    const auto visit = [&](std::int64_t to) {
      auto& s = state_[static_cast<std::size_t>(to)];
      if (s & (solid | lids_ | seen)) return;
      s |= seen;
      queue.push_back(static_cast<Cell>(to));
    };
    const std::int64_t at = c;
    for (const std::int64_t by : sideways_) visit(at + by);
    visit(at - layer_);
    if (layer(c) < top) visit(at + layer_);
  }
  return false;
}

std::optional<int> FloodGrid::spill_layer(const Cells& pool, Index volume, int top) {
  forget();
  std::vector<Cells> queue(static_cast<std::size_t>(n_[2]));
  const auto push = [&](std::int64_t c) {
    auto& s = state_[static_cast<std::size_t>(c)];
    if (s & (solid | lids_ | seen)) return false;
    s |= seen;
    queue[static_cast<std::size_t>(layer(static_cast<Cell>(c)))].push_back(static_cast<Cell>(c));
    return true;
  };
  for (const Cell c : pool) push(c);
  Index filled = 0;
  int highest = 0;
  for (int k = 0; k <= top;) {
    Cells& here = queue[static_cast<std::size_t>(k)];
    if (here.empty()) {
      ++k;
      continue;
    }
    highest = std::max(highest, k);
    const Cell c = here.back();
    if (state_[c] & edge) return highest;
    const std::int64_t at = c;
    // Everything that lies lower is filled before the liquid spreads from here.
    if (push(at - layer_)) {
      --k;
      continue;
    }
    here.pop_back();
    if (++filled >= volume) return std::nullopt;
    for (const std::int64_t by : sideways_) push(at + by);
    push(at + layer_);
  }
  return std::nullopt;
}

// Steps (through faces of cells) to the nearest closed cell, up to 254.
void FloodGrid::measure_clearance() {
  if (measured_lids_ == lids_) return;
  measured_lids_ = lids_;
  clearance_.assign(state_.size(), far);
  Cells front, next;
  for (Cell c = 0; c < state_.size(); ++c)
    if (closed(c) && layer(c) < n_[2] - 1) {
      clearance_[c] = 0;
      front.push_back(c);
    }
  for (std::uint8_t d = 1; d < far && !front.empty(); ++d) {
    next.clear();
    const auto visit = [&](std::int64_t c) {
      if (c < 0 || c >= static_cast<std::int64_t>(clearance_.size()) ||
          clearance_[static_cast<std::size_t>(c)] != far)
        return;
      clearance_[static_cast<std::size_t>(c)] = d;
      next.push_back(static_cast<Cell>(c));
    };
    for (const Cell c : front) {
      const std::int64_t at = c;
      for (const std::int64_t by : sideways_) visit(at + by);
      visit(at - layer_);
      visit(at + layer_);
    }
    front.swap(next);
  }
}

std::vector<FloodGrid::Step> FloodGrid::widest_path(const Cells& pool, int top) {
  measure_clearance();
  forget();
  // The widest cells first: each cell is then reached by the widest path.
  std::vector<Cells> queue(256);
  std::vector<std::size_t> head(256, 0);  // first come, first served: no detours among equals
  std::vector<std::uint8_t> came(state_.size(), start);
  int widest = 0;
  const auto push = [&](std::int64_t c, std::uint8_t from) {
    auto& s = state_[static_cast<std::size_t>(c)];
    if ((s & (solid | lids_ | seen)) || layer(static_cast<Cell>(c)) > top) return;
    s |= seen;
    came[static_cast<std::size_t>(c)] = from;
    const int d = clearance_[static_cast<std::size_t>(c)];
    queue[static_cast<std::size_t>(d)].push_back(static_cast<Cell>(c));
    widest = std::max(widest, d);
  };
  for (const Cell c : pool) push(c, start);
  std::vector<Step> path;
  while (widest >= 0) {
    const auto w = static_cast<std::size_t>(widest);
    if (head[w] == queue[w].size()) {
      --widest;
      continue;
    }
    Cell c = queue[w][head[w]++];
    std::int64_t at = c;
    if (state_[c] & edge) {
      while (came[c] != start) {
        const std::uint8_t from = came[c];
        path.push_back({outer(center(c)), clearance_[c], from == from_above});
        at = c;
        c = static_cast<Cell>(from == from_above   ? at + layer_
                              : from == from_below ? at - layer_
                                                   : at - sideways_[from - 1u]);
      }
      std::reverse(path.begin(), path.end());
      return path;
    }
    for (std::size_t k = 0; k < sideways_.size(); ++k)
      push(at + sideways_[k], static_cast<std::uint8_t>(k + 1));
    push(at - layer_, from_above);
    push(at + layer_, from_below);
  }
  return path;
}

}  // namespace sphgeo
