#include "geometry/level_set_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "sph/kernel.h"

namespace sphgeo {

namespace {

constexpr std::int32_t wholly_inside = -1, wholly_outside = -2;
constexpr double nodes_per_h = 2.6;
// Errors of a model of the surface in the middle of its cell, over the node distance: one that is
// taken before all others, and one that is better than to ask the shape at every step.
constexpr double good_model = 0.01;
constexpr double fair_model = 0.1;
// Planes that meet in a cell, at most.
constexpr std::size_t most_planes = 6;

}  // namespace

template <int Dim>
LevelSetMesh<Dim>::LevelSetMesh(const Vec3& lo, const Vec3& hi, double h, double band)
    : lo_(lo), hi_(hi), h_(h), width_(h / nodes_per_h), band_(band) {
  for (int k = 0; k < 3; ++k)
    blocks_[k] = Dim == 2 && k == 1 ? 1
                                    : static_cast<Index>(std::ceil(
                                          (hi[k] - lo[k]) / (width_ * static_cast<double>(edge_))));
  slot_.assign(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]), wholly_inside);
  deep_[0].distance = static_cast<float>(-band);
  deep_[1].distance = static_cast<float>(band);
}

template <int Dim>
LevelSetMesh<Dim>::LevelSetMesh(const Shape& shape, const Aabb& around, double h, double band,
                                double level)
    : LevelSetMesh(around.lo.array() - band, around.hi.array() + band, h, band) {
  fill(shape, [&](const Vec3& at) { return shape.bound(at); });
  if (shape.composed()) find_distances(shape);
  finish();
  for_each_stored([&](Block& block) { choose_models(block, shape, level); });
}

template <int Dim>
LevelSetMesh<Dim>::LevelSetMesh(const Shape& shape, const LevelSetMesh& finer, double h)
    : LevelSetMesh(finer.lo_, finer.hi_, h, finer.band_) {
  fill(shape, [&](const Vec3& at) { return finer.distance(to_scene<Dim>(at)); });
  finish();
}

template <int Dim>
template <class F>
void LevelSetMesh<Dim>::for_each_stored(F&& f) {
  parallel_blocks(static_cast<Index>(stored_.size()), 1,
                  [&](Index b, Index, Index) { f(stored_[static_cast<std::size_t>(b)]); });
}

template <int Dim>
template <class F>
void LevelSetMesh<Dim>::fill(const Shape& shape, F&& distance) {
  // A block is stored when it may hold a node within the band, or near the surface outside.
  const double half = 0.5 * static_cast<double>(edge_ - 1) * width_;
  const double reach = half * std::sqrt(static_cast<double>(Dim)) + width_;
  const auto first_node = [&](Index b) {
    return Place{b % blocks_[0] * edge_, b / blocks_[0] % blocks_[1] * edge_,
                 b / (blocks_[0] * blocks_[1]) * edge_};
  };
  std::vector<double> center(slot_.size());
  parallel_blocks(static_cast<Index>(slot_.size()), 8, [&](Index begin, Index end, Index) {
    for (Index b = begin; b < end; ++b) {
      Vec3 c = position(first_node(b)) + Vec3::Constant(half);
      if (Dim == 2) c.y() = 0.0;
      center[static_cast<std::size_t>(b)] = shape.bound(c);
    }
  });
  for (std::size_t b = 0; b < slot_.size(); ++b) {
    if (center[b] < -reach - band_) continue;
    if (center[b] > reach + 2 * width_) {
      slot_[b] = wholly_outside;
    } else {
      slot_[b] = static_cast<std::int32_t>(stored_.size());
      stored_.push_back({first_node(static_cast<Index>(b)), {}, {}, {}});
    }
  }
  for_each_stored([&](Block& block) {
    block.nodes.resize(static_cast<std::size_t>(block_nodes_));
    for (Index k = 0; k < block_nodes_; ++k)
      block.nodes[static_cast<std::size_t>(k)].distance =
          static_cast<float>(distance(position(place(block, k))));
  });
}

template <int Dim>
void LevelSetMesh<Dim>::find_distances(const Shape& shape) {
  // The bound has the right sign. Where it says "near" and nothing outside is within two nodes, as
  // on the seam of two parts, it is nearer than the surface, whose distance is then not needed.
  constexpr Index ring = 2;
  const auto near_outside = [](const Around& outside, Index k) {
    const auto middle = outside.value.begin() + outside.at(k);
    for (Index z = -ring; z <= ring; ++z)
      for (Index y = -outside.reach_y(); y <= outside.reach_y(); ++y) {
        const auto row = middle + (z * outside.ny + y) * outside.nx;
        if (std::any_of(row - ring, row + ring + 1, [](float v) { return v > 0; })) return true;
      }
    return false;
  };
  std::vector<std::vector<float>> found(stored_.size());
  parallel_blocks(static_cast<Index>(stored_.size()), 1, [&](Index b, Index, Index) {
    const Block& block = stored_[static_cast<std::size_t>(b)];
    const Around signs = around(block, ring, [](const Node& n) { return n.distance; });
    std::vector<float>& out = found[static_cast<std::size_t>(b)];
    for (Index k = 0; k < block_nodes_; ++k) {
      const double bound = block.nodes[static_cast<std::size_t>(k)].distance;
      out.push_back(static_cast<float>(bound));
      if (bound < -(ring + 1) * width_ || bound > 1.5 * width_) continue;
      out.back() = static_cast<float>(near_outside(signs, k)
                                          ? shape.signed_distance(position(place(block, k)))
                                          : std::min(bound, -(ring - 0.5) * width_));
    }
  });
  for (std::size_t b = 0; b < stored_.size(); ++b)
    for (std::size_t k = 0; k < found[b].size(); ++k) stored_[b].nodes[k].distance = found[b][k];
}

template <int Dim>
void LevelSetMesh<Dim>::finish() {
  const double cell_volume = std::pow(width_, Dim);
  volume_ = cell_volume * static_cast<double>(
                              block_nodes_ * std::count(slot_.begin(), slot_.end(), wholly_inside));
  for (const Block& block : stored_)
    for (const Node& n : block.nodes)
      volume_ += cell_volume * std::clamp(0.5 - n.distance / width_, 0.0, 1.0);
  for_each_stored([&](Block& block) {
    set_normals(block);
    sum_outside(block);
  });
}

template <int Dim>
auto LevelSetMesh<Dim>::place(const Block& block, Index k) -> Place {
  return {block.first[0] + k % edge_, block.first[1] + k / edge_ % edge_y_,
          block.first[2] + k / (edge_ * edge_y_)};
}

template <int Dim>
template <class F>
auto LevelSetMesh<Dim>::around(const Block& block, Index reach, F&& f) const -> Around {
  Around out{reach, edge_ + 2 * reach, Dim == 3 ? edge_ + 2 * reach : 1, {}};
  for (Index z = -reach; z < edge_ + reach; ++z)
    for (Index y = -out.reach_y(); y < edge_y_ + out.reach_y(); ++y)
      for (Index x = -reach; x < edge_ + reach; ++x)
        out.value.push_back(f(node({block.first[0] + x, block.first[1] + y, block.first[2] + z})));
  return out;
}

template <int Dim>
Vec3 LevelSetMesh<Dim>::position(const Place& at) const {
  Vec3 p = lo_ + width_ * Vec3(static_cast<double>(at[0]), static_cast<double>(at[1]),
                               static_cast<double>(at[2]));
  if (Dim == 2) p.y() = 0.0;
  return p;
}

template <int Dim>
std::int32_t LevelSetMesh<Dim>::slot(const Place& at) const {
  for (std::size_t k = 0; k < 3; ++k)
    if (at[k] < 0 || at[k] >= blocks_[k] * edge_) return wholly_outside;
  return slot_[static_cast<std::size_t>(
      ((at[2] / edge_) * blocks_[1] + at[1] / edge_) * blocks_[0] + at[0] / edge_)];
}

template <int Dim>
auto LevelSetMesh<Dim>::node(const Place& at) const -> const Node& {
  const std::int32_t s = slot(at);
  if (s < 0) return deep_[s == wholly_outside];
  return stored_[static_cast<std::size_t>(s)].nodes[static_cast<std::size_t>(
      ((at[2] % edge_) * edge_y_ + at[1] % edge_) * edge_ + at[0] % edge_)];
}

template <int Dim>
auto LevelSetMesh<Dim>::below(const Vec<Dim>& p) const -> Place {
  const Vec3 at = (to_space<Dim>(p) - lo_) / width_;
  Place low{};
  for (int k = 0; k < 3; ++k)
    if (Dim == 3 || k != 1)
      low[static_cast<std::size_t>(k)] = static_cast<Index>(std::floor(at[k]));
  return low;
}

template <int Dim>
template <class F>
void LevelSetMesh<Dim>::for_each_corner(const Place& low, const Vec<Dim>& p, F&& f) const {
  const Vec<Dim> from_low = p - to_scene<Dim>(position(low)), part = from_low / width_;
  for (int k = 0; k < 1 << Dim; ++k) {
    double weight = 1.0;
    Place at = low;
    Vec<Dim> from = from_low;
    for (int d = 0; d < Dim; ++d) {
      const int up = k >> d & 1;
      weight *= up ? part[d] : 1.0 - part[d];
      at[static_cast<std::size_t>(Dim == 2 ? 2 * d : d)] += up;
      from[d] -= up * width_;
    }
    f(node(at), weight, from);
  }
}

template <int Dim>
auto LevelSetMesh<Dim>::missing(const Vec<Dim>& p) const -> Missing {
  Missing out;
  for_each_corner(below(p), p, [&](const Node& n, double weight, const Vec<Dim>&) {
    for (int d = 0; d < Dim; ++d) out.gradient[d] += weight * n.gradient[d];
    out.sum += weight * n.sum;
  });
  return out;
}

template <int Dim>
double LevelSetMesh<Dim>::distance(const Vec<Dim>& p) const {
  double out = 0.0;
  for_each_corner(below(p), p, [&](const Node& n, double weight, const Vec<Dim>&) {
    out += weight * n.distance;
  });
  return out;
}

template <int Dim>
auto LevelSetMesh<Dim>::blend(const Place& low, const Vec<Dim>& p) const -> Tangent {
  // Half of the slope at each corner makes linear interpolation exact for parabolas.
  Tangent out{p, Vec<Dim>::Zero(), 0.0};
  for_each_corner(low, p, [&](const Node& n, double weight, const Vec<Dim>& from) {
    double d = n.distance;
    for (int k = 0; k < Dim; ++k) {
      d += 0.5 * n.normal[k] * from[k];
      out.normal[k] += weight * n.normal[k];
    }
    out.distance += weight * d;
  });
  return out;
}

template <int Dim>
auto LevelSetMesh<Dim>::tangents(const Place& low) const -> std::vector<Tangent> {
  // Beside an edge each node that does not see both sides knows one plane.
  std::vector<Tangent> out;
  const Vec<Dim> middle = to_scene<Dim>(position(low)) + Vec<Dim>::Constant(0.5 * width_);
  for (Index z = -1; z <= 2; ++z)
    for (Index y = Dim == 3 ? -1 : 0; y <= (Dim == 3 ? 2 : 0); ++y)
      for (Index x = -1; x <= 2; ++x) {
        const Place at{low[0] + x, low[1] + y, low[2] + z};
        const Node& n = node(at);
        Tangent t{to_scene<Dim>(position(at)), Vec<Dim>::Zero(), n.distance};
        for (int d = 0; d < Dim; ++d) t.normal[d] = n.normal[d];
        if (std::abs(t.normal.norm() - 1.0) > 1e-3) continue;
        const bool known = std::any_of(out.begin(), out.end(), [&](const Tangent& other) {
          return (other.normal - t.normal).norm() < 1e-2 &&
                 std::abs(other(middle) - t(middle)) < good_model * width_;
        });
        if (!known) out.push_back(t);
      }
  return out;
}

template <int Dim>
bool LevelSetMesh<Dim>::move_below(Vec<Dim>& p, double level) const {
  const Place low = below(p);
  const std::int32_t s = slot(low);
  if (s < 0) return false;
  const Block& block = stored_[static_cast<std::size_t>(s)];
  const auto k = static_cast<std::size_t>(((low[2] % edge_) * edge_y_ + low[1] % edge_) * edge_ +
                                          low[0] % edge_);
  const std::int16_t model = block.model.empty() ? none : block.model[k];
  if (model == none) return false;
  if (model == smooth) {
    const Tangent t = blend(low, p);
    p -= std::max(0.0, t.distance - level) * t.normal.normalized();
    return true;
  }
  // Planes that are not at right angles want to be asked again.
  for (int round = 0; round < 3; ++round)
    for (const Tangent& t : block.edges[static_cast<std::size_t>(model)])
      p -= std::max(0.0, t(p) - level) * t.normal;
  return true;
}

template <int Dim>
void LevelSetMesh<Dim>::set_normals(Block& block) const {
  Place at;
  auto n = block.nodes.begin();
  for (at[2] = block.first[2]; at[2] < block.first[2] + edge_; ++at[2])
    for (at[1] = block.first[1]; at[1] < block.first[1] + edge_y_; ++at[1])
      for (at[0] = block.first[0]; at[0] < block.first[0] + edge_; ++at[0], ++n) {
        if (std::abs(n->distance) > 0.9 * band_) continue;
        for (int d = 0; d < Dim; ++d) {
          Place before = at, after = at;
          const auto axis = static_cast<std::size_t>(Dim == 2 ? 2 * d : d);
          --before[axis];
          ++after[axis];
          n->normal[d] =
              static_cast<float>((node(after).distance - node(before).distance) / (2.0 * width_));
        }
      }
}

template <int Dim>
void LevelSetMesh<Dim>::choose_models(Block& block, const Shape& shape, double level) const {
  block.model.assign(block.nodes.size(), none);
  for (std::size_t k = 0; k < block.nodes.size(); ++k) {
    if (std::abs(block.nodes[k].distance - level) > 2.5 * width_) continue;
    const Place low = place(block, static_cast<Index>(k));
    const Vec<Dim> middle = to_scene<Dim>(position(low)) + Vec<Dim>::Constant(0.5 * width_);
    const Tangent t = blend(low, middle);
    if (std::abs(t.distance - level) > 1.2 * width_) continue;
    const double distance = shape.signed_distance(to_space<Dim>(middle));
    const double smooth_error =
        std::abs(t.normal.norm() - 1.0) < 0.3 ? std::abs(t.distance - distance) : width_;
    if (smooth_error > good_model * width_) {
      std::vector<Tangent> planes = tangents(low);
      double largest = -1e300;
      for (const Tangent& plane : planes) largest = std::max(largest, plane(middle));
      if (planes.size() <= most_planes &&
          std::abs(largest - distance) < std::min(smooth_error, fair_model * width_)) {
        block.model[k] = static_cast<std::int16_t>(block.edges.size());
        block.edges.push_back(std::move(planes));
        continue;
      }
    }
    if (smooth_error < fair_model * width_) block.model[k] = smooth;
  }
}

template <int Dim>
void LevelSetMesh<Dim>::sum_outside(Block& block) const {
  // Nothing is missing deep inside; nodes beyond the surface serve interpolation only.
  const Kernel<Dim> kernel(h_);
  const auto wanted = [&](const Node& n) {
    return n.distance > -kernel.support() - width_ && n.distance < 2.0 * width_;
  };
  if (std::none_of(block.nodes.begin(), block.nodes.end(), wanted)) return;
  // Shares of the cells around that lie outside: the surface cuts the cell of a node, and its
  // distance tells by how much, without a jump.
  const auto reach = static_cast<Index>(std::ceil(kernel.support() / width_));
  const Around outside = around(block, reach, [&](const Node& n) {
    return static_cast<float>(std::clamp(0.5 + n.distance / width_, 0.0, 1.0));
  });
  struct Term {
    Index offset;
    float gradient[Dim], value;
  };
  std::vector<Term> terms;
  const double cell_volume = std::pow(width_, Dim);
  for (Index z = -reach; z <= reach; ++z)
    for (Index y = -outside.reach_y(); y <= outside.reach_y(); ++y)
      for (Index x = -reach; x <= reach; ++x) {
        const Vec<Dim> apart =
            -width_ * to_scene<Dim>(Vec3(static_cast<double>(x), static_cast<double>(y),
                                         static_cast<double>(z)));
        const double r2 = apart.squaredNorm();
        if (r2 >= kernel.support() * kernel.support()) continue;
        Term t{(z * outside.ny + y) * outside.nx + x,
               {},
               static_cast<float>(kernel.w(r2) * cell_volume)};
        for (int d = 0; d < Dim; ++d)
          t.gradient[d] = static_cast<float>(kernel.dw_over_r(r2) * cell_volume * apart[d]);
        terms.push_back(t);
      }
  // A row of nodes at a time.
  using Row = Eigen::Array<float, edge_, 1>;
  for (Index row = 0; row < edge_y_ * edge_; ++row) {
    Node* n = block.nodes.data() + row * edge_;
    if (std::none_of(n, n + edge_, wanted)) continue;
    const float* first = outside.value.data() + outside.at(row * edge_);
    Row value = Row::Zero(), gradient[Dim];
    for (Row& g : gradient) g = Row::Zero();
    for (const Term& t : terms) {
      const Row share = Eigen::Map<const Row>(first + t.offset);
      value += t.value * share;
      for (int d = 0; d < Dim; ++d) gradient[d] += t.gradient[d] * share;
    }
    for (Index x = 0; x < edge_; ++x) {
      if (!wanted(n[x])) continue;
      n[x].sum = value[x];
      for (int d = 0; d < Dim; ++d) n[x].gradient[d] = gradient[d][x];
    }
  }
}

template class LevelSetMesh<2>;
template class LevelSetMesh<3>;

}  // namespace sphgeo
