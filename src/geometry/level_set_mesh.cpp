#include "geometry/level_set_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "sph/kernel.h"

namespace sphgeo {

namespace {

constexpr std::int32_t wholly_inside = -1, wholly_outside = -2;
constexpr double nodes_per_h = 2.6;
// Between smoothing lengths a factor of 1.2 apart a straight line is within 0.5 % of the sums.
constexpr double mesh_ratio = 1.2;

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
LevelSetMesh<Dim>::LevelSetMesh(const Shape& shape, const Aabb& around, double h, double band)
    : LevelSetMesh(around.lo.array() - band, around.hi.array() + band, h, band) {
  fill(shape, [&](const Vec3& at) { return shape.bound(at); });
  if (shape.composed()) find_distances(shape);
  finish();
}

template <int Dim>
LevelSetMesh<Dim>::LevelSetMesh(const Shape& shape, const LevelSetMesh& finer, double h)
    : LevelSetMesh(finer.lo_, finer.hi_, h, finer.band_) {
  fill(shape, [&](const Vec3& at) { return finer.distance(to_scene<Dim>(at)).value; });
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
      stored_.push_back({first_node(static_cast<Index>(b)), {}});
    }
  }
  for_each_stored([&](Block& block) {
    block.nodes.resize(static_cast<std::size_t>(block_nodes_));
    for (Index k = 0; k < block_nodes_; ++k)
      block.nodes[static_cast<std::size_t>(k)].distance =
          static_cast<float>(std::clamp(distance(position(place(block, k))), -band_, band_));
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
  for_each_stored([&](Block& block) { sum_outside(block); });
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
        out.value.push_back(
            f(*find({block.first[0] + x, block.first[1] + y, block.first[2] + z}).node));
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
auto LevelSetMesh<Dim>::find(const Place& at) const -> Found {
  for (std::size_t k = 0; k < 3; ++k)
    if (at[k] < 0 || at[k] >= blocks_[k] * edge_) return {&deep_[1], false};
  const std::int32_t s = slot_[static_cast<std::size_t>(
      (at[2] / edge_ * blocks_[1] + at[1] / edge_) * blocks_[0] + at[0] / edge_)];
  if (s < 0) return {&deep_[s == wholly_outside], false};
  const Index k = (at[2] % edge_ * edge_y_ + at[1] % edge_) * edge_ + at[0] % edge_;
  return {&stored_[static_cast<std::size_t>(s)].nodes[static_cast<std::size_t>(k)], true};
}

template <int Dim>
template <class F>
Vec<Dim> LevelSetMesh<Dim>::for_each_corner(const Vec<Dim>& p, F&& f) const {
  constexpr std::size_t axis[3] = {0, Dim == 2 ? 2 : 1, 2};
  constexpr Index step[3] = {1, edge_, edge_ * edge_y_};
  Vec<Dim> part = (p - to_scene<Dim>(lo_)) / width_;
  Place low{};
  bool one_block = true;  // as for most cells
  for (int d = 0; d < Dim; ++d) {
    const double whole = std::floor(part[d]);
    part[d] -= whole;
    low[axis[d]] = static_cast<Index>(whole);
    one_block = one_block && low[axis[d]] % edge_ != edge_ - 1;
  }
  const Found first = find(low);
  for (int k = 0; k < 1 << Dim; ++k) {
    Index offset = 0;
    Place at = low;
    for (int d = 0; d < Dim; ++d) {
      offset += (k >> d & 1) * step[axis[d]];
      at[axis[d]] += k >> d & 1;
    }
    f(k, one_block ? first.node[first.stored ? offset : 0] : *find(at).node);
  }
  return part;
}

template <int Dim>
auto LevelSetMesh<Dim>::missing(const Vec<Dim>& p) const -> Missing {
  Sums at[1 << Dim];
  const Vec<Dim> part = for_each_corner(p, [&](int k, const Node& n) { at[k] = n.sums; });
  for (int d = Dim - 1; d >= 0; --d)
    for (int k = 0; k < 1 << d; ++k)
      at[k] += static_cast<float>(part[d]) * (at[k + (1 << d)] - at[k]);
  Missing out;
  for (int d = 0; d < Dim; ++d) out.gradient[d] = at[0][d];
  out.sum = at[0][3];
  return out;
}

template <int Dim>
auto LevelSetMesh<Dim>::distance(const Vec<Dim>& p) const -> Distance {
  double at[1 << Dim];
  const Vec<Dim> part = for_each_corner(p, [&](int k, const Node& n) { at[k] = n.distance; });
  Distance out;
  for (int k = 0; k < 1 << Dim; ++k)
    for (int d = -1; d < Dim; ++d) {  // the value, then the slope along each axis
      double weight = at[k];
      for (int e = 0; e < Dim; ++e) {
        const bool up = k >> e & 1;
        weight *= e == d ? (up ? 1.0 : -1.0) / width_ : up ? part[e] : 1.0 - part[e];
      }
      (d < 0 ? out.value : out.gradient[d]) += weight;
    }
  return out;
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
  // distance tells by how much, without a jump. The middle of a part that is cut off lies farther
  // out than its node, so some of it counts as the next node's: then the sums do not depend on
  // where the surface runs between the nodes.
  const auto cut = [&](double distance) { return std::clamp(0.5 + distance / width_, 0.0, 1.0); };
  const auto reach = static_cast<Index>(std::ceil(kernel.support() / width_));
  const Around outside = around(block, reach, [&](const Node& n) {
    const double own = cut(n.distance), inner = cut(n.distance - width_);
    return static_cast<float>(own * (1 + own) / 2 + inner * (1 - inner) / 2);
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
      for (int d = 0; d < Dim; ++d) n[x].sums[d] = gradient[d][x];
      n[x].sums[3] = value[x];
    }
  }
}

template <int Dim>
MissingSupport<Dim>::MissingSupport(const Shape& shape, const Aabb& around, double h_low,
                                    double h_high)
    : h_{h_low} {
  const int intervals =
      static_cast<int>(std::ceil(std::log(h_high / h_low) / std::log(mesh_ratio) - 1e-9));
  mesh_.reserve(static_cast<std::size_t>(intervals) + 1);
  mesh_.emplace_back(shape, around, h_low, 2.5 * h_high);
  for (int k = 1; k <= intervals; ++k) {
    h_.push_back(h_low * std::pow(h_high / h_low, static_cast<double>(k) / intervals));
    mesh_.emplace_back(shape, mesh_.front(), h_.back());
  }
}

template <int Dim>
typename LevelSetMesh<Dim>::Missing MissingSupport<Dim>::operator()(const Vec<Dim>& p,
                                                                    double h) const {
  const auto above = std::upper_bound(h_.begin(), h_.end(), h) - h_.begin();
  if (above == 0 || h_.size() == 1) return mesh_.front().missing(p);
  if (above == static_cast<std::ptrdiff_t>(h_.size())) return mesh_.back().missing(p);
  const auto k = static_cast<std::size_t>(above);
  const double share = (h - h_[k - 1]) / (h_[k] - h_[k - 1]);
  auto low = mesh_[k - 1].missing(p);
  const auto high = mesh_[k].missing(p);
  low.gradient = (1 - share) * low.gradient + share * high.gradient;
  low.sum = (1 - share) * low.sum + share * high.sum;
  return low;
}

template class LevelSetMesh<2>;
template class LevelSetMesh<3>;
template class MissingSupport<2>;
template class MissingSupport<3>;

}  // namespace sphgeo
