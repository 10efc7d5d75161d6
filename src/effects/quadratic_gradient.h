#pragma once
// What makes the gradient of Eq. 66 exact for quadratic fields too.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "deck/interfaces.h"
#include "effects/solid_phase.h"

namespace sphgeo {

/// How far a particle is from the face of the resting clamp that holds it or is near, m: positive
/// outside; empty if there is none.
template <int Dim>
std::optional<double> clamp_distance(const SolidPart& body, const Vec<Dim>& at) {
  std::optional<double> nearest;
  for (const ClampPart& clamp : body.clamped)
    if (!clamp.motion)
      if (const double d = clamp.shape->signed_distance(to_space<Dim>(at));
          !nearest || d < *nearest)
        nearest = d;
  return nearest;
}

/// Weights that are added to those of Eq. 66. In the bulk of a lattice those see a quadratic
/// field's gradient exactly; near a surface they see it at a point further inside, by a fifth of a
/// spacing or two: a plate of eight layers bends as if it were a twentieth thinner. The least
/// change (in the norm of the kernel) that makes the gradient exact for the products of two
/// coordinates, and leaves it exact for linear fields; none where the neighbors cannot tell, as in
/// a plate of two layers.
///
/// Clamps. A held particle says that there is no displacement where it is, but the strain may begin
/// at the face of the clamp, half a spacing before it and more: a clamped plate bends as if it were
/// a spacing longer. So a free particle sees in place of a held one the mirror image of its own
/// displacement, as water does at a wall (Eq. 95); what is held has no strain of its own. This is
/// one vector per particle, kept as a weight of the particle on itself.
///
/// by_target holds delta g_ij, by_source B_i^-1 delta g_ij for the forces, which stay the gradient
/// of the energy.
template <int Dim>
PairWeights<Dim> quadratic_weights(World<Dim>& world, const std::string& name) {
  constexpr int terms = Dim + Dim * (Dim + 1) / 2;
  using Terms = Eigen::Matrix<double, terms, 1>;
  using Moments = Eigen::Matrix<double, terms, terms>;
  const ParticleSet<Dim>& set = world.set(name);
  const auto& at = set.vector(fields::reference_position);
  const auto& volume = set.scalar(fields::reference_volume);
  const auto& correction = set.tensor(fields::reference_correction);
  const auto& part = set.tag(fields::part);
  const auto& clamp = set.tag(fields::clamp);
  const double h = set.smoothing_length();
  const Kernel<Dim> kernel(h);
  const auto monomials = [&](const Vec<Dim>& r) {  // of the distance to the neighbor
    Terms p;
    for (int k = 0; k < Dim; ++k) p[k] = r[k] / h;
    for (int k = 0, n = Dim; k < Dim; ++k)
      for (int l = k; l < Dim; ++l, ++n) p[n] = r[k] * r[l] / (h * h);
    return p;
  };
  std::vector<std::vector<typename PairWeights<Dim>::Entry>> rows(
      static_cast<std::size_t>(set.size())),
      turned(rows.size());
  const auto blocks = world.reference_list(name).blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    const auto& block = blocks[static_cast<std::size_t>(b)];
    for (std::size_t t = 0; t < block.size(); ++t) {
      const Index i = block.targets[t];
      const Mat<Dim> inverse = to_matrix<Dim>(correction[i]);
      Moments moments = Moments::Zero();
      Eigen::Matrix<double, terms, Dim> wrong = Eigen::Matrix<double, terms, Dim>::Zero();
      const auto for_neighbors = [&](auto&& f) {
        for (std::uint32_t e = 0; e < block.count[t]; ++e) {
          const auto j = static_cast<Index>(block.entries[block.begin[t] + e] / 8);
          const Vec<Dim> r = at[j] - at[i];
          f(j, r, kernel.w(r.squaredNorm()) * volume[i], monomials(r));
        }
      };
      for_neighbors([&](Index, const Vec<Dim>& r, double w, const Terms& p) {
        moments += w * p * p.transpose();
        const Vec<Dim> g = -volume[i] * kernel.dw_over_r(r.squaredNorm()) * inverse * r;
        wrong += p * g.transpose();
      });
      const Mat<Dim> back = inverse.inverse();
      const auto keep = [&](Index other, const Vec<Dim>& change) {
        const Vec<Dim> changed = back * change;
        typename PairWeights<Dim>::Entry entry{static_cast<std::uint32_t>(other), {}}, turn = entry;
        for (int k = 0; k < Dim; ++k) {
          entry.weight[k] = static_cast<float>(change[k]);
          turn.weight[k] = static_cast<float>(changed[k]);
        }
        rows[static_cast<std::size_t>(i)].push_back(entry);
        turned[static_cast<std::size_t>(i)].push_back(turn);
      };
      const SolidPart& body = world.parameters().solids[part[i]];
      if (clamp[i] < 0 && !body.clamped.empty()) {
        Vec<Dim> mirrored = Vec<Dim>::Zero();
        const double own =
            std::max(clamp_distance<Dim>(body, at[i]).value_or(0), 0.499 * set.spacing());
        for_neighbors([&](Index j, const Vec<Dim>& r, double, const Terms&) {
          if (clamp[j] < 0 || body.clamped[static_cast<std::size_t>(clamp[j])].motion) return;
          mirrored += std::max(0.0, -clamp_distance<Dim>(body, at[j]).value_or(0)) / own *
                      (-volume[i] * kernel.dw_over_r(r.squaredNorm()) * inverse * r);
        });
        if (mirrored.norm() > 0) keep(i, mirrored);
      }
      wrong.template topRows<Dim>().setZero();  // what B0 makes right already
      if (wrong.norm() * h < 1e-6) continue;
      const Eigen::SelfAdjointEigenSolver<Moments> axes(moments);
      Terms inverse_of = axes.eigenvalues();
      for (int n = 0; n < terms; ++n)
        inverse_of[n] =
            inverse_of[n] > 1e-5 * axes.eigenvalues()[terms - 1] ? 1 / inverse_of[n] : 0;
      const Eigen::Matrix<double, terms, Dim> factor =
          -axes.eigenvectors() * inverse_of.asDiagonal() * axes.eigenvectors().transpose() * wrong;
      if ((moments * factor + wrong).norm() > 1e-6 * wrong.norm()) continue;
      for_neighbors([&](Index j, const Vec<Dim>&, double w, const Terms& p) {
        keep(j, w * (factor.transpose() * p));
      });
    }
  });
  PairWeights<Dim> weights;
  const auto pack = [](const auto& lists, auto& to) {
    to.begin.assign(1, 0);
    for (const auto& list : lists) {
      to.entries.insert(to.entries.end(), list.begin(), list.end());
      to.begin.push_back(static_cast<std::uint32_t>(to.entries.size()));
    }
  };
  pack(rows, weights.by_target);
  std::vector<std::vector<typename PairWeights<Dim>::Entry>> sources(rows.size());
  for (std::size_t i = 0; i < turned.size(); ++i)
    for (auto entry : turned[i]) {
      const std::size_t j = entry.other;
      entry.other = static_cast<std::uint32_t>(i);
      if (j != i) sources[j].push_back(entry);
      // The particle itself bears minus the sum of its weights.
      for (float& w : entry.weight) w = -w;
      sources[i].push_back(entry);
    }
  pack(sources, weights.by_source);
  return weights;
}

}  // namespace sphgeo
