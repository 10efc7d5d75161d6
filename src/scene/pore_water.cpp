#include "scene/pore_water.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/text.h"
#include "geometry/fill.h"
#include "geometry/shapes.h"
#include "scene/acceptance.h"
#include "scene/body_filling.h"
#include "scene/smooth_fraction.h"

namespace sphgeo {
namespace {

// A draft of more particles than this stays as it was accepted.
constexpr Index quick = 30'000;
// What lies farther than this from soil, in spacings, and from cells that a surface cuts, keeps its
// place on the lattice: the noise of an accepted cell is gone within one kernel.
constexpr double lattice_distance = 6;

/// The number of the body (among `bodies`) that holds a place: its own unless it has left it.
std::size_t holder(const Model& model, const std::vector<std::size_t>& bodies, std::size_t own,
                   const Vec3& at) {
  const auto depth = [&](std::size_t k) { return model.bodies[bodies[k]].shape->bound(at); };
  if (bodies.size() == 1 || depth(own) < 0) return own;
  std::size_t best = own;
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (depth(k) < depth(best)) best = k;
  return best;
}

/// Reorders per-particle values so that the bodies follow each other.
template <class T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> out;
  out.reserve(order.size());
  for (const std::size_t k : order) out.push_back(values[k]);
  values = std::move(out);
}

/// Accepts and relaxes. Throws Error where a body cannot be filled.
PoreWater fill(const Model& model, const PoreBodies& pores, bool draft) {
  const auto start = std::chrono::steady_clock::now();
  const double dp = model.resolution;
  const int dim = model.dimension;
  const WaterTarget target(model);
  std::vector<Candidate> all;
  std::vector<std::size_t> ends;  // of each body's candidates
  for (const std::size_t b : pores.bodies) {
    const std::vector<Candidate> some =
        candidates(*model.bodies[b].shape, target, dp, dim, lattice_distance * dp);
    all.insert(all.end(), some.begin(), some.end());
    ends.push_back(all.size());
  }
  const Acceptance kind = model.relaxation.acceptance == "independent" ? Acceptance::independent
                                                                       : Acceptance::stratified;
  const std::vector<std::size_t> accepted =
      accept(all, kind, static_cast<std::uint64_t>(model.relaxation.seed), dp, dim);

  PoreWater out;
  out.bodies = pores.bodies;
  out.volume = water_volume(all) * std::pow(dp, dim);
  out.accepted = static_cast<Index>(accepted.size());
  Seeds seeds;
  Aabb moving;
  std::vector<std::size_t> body;
  for (const std::size_t k : accepted) {
    const auto own =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), k) - ends.begin());
    const bool relaxed = filling_of(model.bodies[pores.bodies[own]], model).relaxed;
    // A soil of another body may begin right beside this one.
    const bool fixed = !relaxed && !all[k].near_cut && all[k].water == 1 &&
                       target.locate(all[k].at).holds > lattice_distance * dp;
    seeds.at.push_back(all[k].at);
    seeds.free.push_back(!fixed);
    out.moved += !fixed;
    if (!fixed) moving.extend(all[k].at);
    body.push_back(own);
  }
  out.start = seeds.at;
  RelaxationOptions options;
  options.steps = draft && out.moved > quick ? 0 : model.relaxation.steps;
  options.tolerance = model.relaxation.tolerance;
  options.run_h = model.numerics.h_factor_water.value_or(1.8) * dp;
  RelaxationTarget fraction;
  std::optional<SmoothFraction> smooth;
  if (out.moved > 0) {
    smooth.emplace(*pores.water, target, moving.grown(2 * dp), dp, options.run_h, dim);
    fraction.fraction = std::cref(*smooth);
  }
  fraction.smallest_fraction = WaterTarget::smallest;
  fraction.volume = std::pow(dp, dim);
  RelaxedPositions relaxed = relax(*pores.water, fraction, std::move(seeds), dp, dim, options);
  out.history = std::move(relaxed.history);
  out.water_density_spread = relaxed.run_density_spread;
  out.interior = relaxed.interior;
  out.water_fraction = std::move(relaxed.fraction);
  out.number_density = std::move(relaxed.number_density);
  out.start_density = std::move(relaxed.start_density);

  out.particles.resize(pores.bodies.size());
  std::vector<std::vector<std::size_t>> members(pores.bodies.size());
  for (std::size_t k = 0; k < body.size(); ++k) {
    const std::size_t b = holder(model, pores.bodies, body[k], relaxed.at[k]);
    out.particles[b].push_back(relaxed.at[k]);
    members[b].push_back(k);
  }
  std::vector<std::size_t> order;
  for (const auto& some : members) order.insert(order.end(), some.begin(), some.end());
  reorder(out.start, order);
  reorder(out.start_density, order);
  reorder(out.water_fraction, order);
  reorder(out.number_density, order);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

/// What the deck's file holds, if it was made for this deck.
std::optional<PoreWater> stored(const Model& model, const PoreBodies& pores, Diagnostics& found) {
  const std::string path = "relaxation.file", &file = model.relaxation.file->path;
  const auto refuse = [&](const std::string& why, const std::string& help) {
    found.error("E132", model.place_of(path), path, why, help);
    return std::nullopt;
  };
  const std::string again =
      "make it again with 'sphgeo relax', or leave the file out: the deck then relaxes by itself";
  try {
    const StateFileReader in(relaxed_kind(), file);
    std::vector<std::string> differences =
        differing_keys(in.text("depends_on"), depends_on(model, pores));
    if (!differences.empty()) {
      constexpr std::size_t most = 6;
      const std::size_t more = differences.size() > most ? differences.size() - most : 0;
      differences.resize(std::min(differences.size(), most));
      return refuse(
          fmt::format("the stored water was made for something else: {}{}",
                      fmt::join(differences, "; "), more ? fmt::format("; and {} more", more) : ""),
          again);
    }
    return take(in, pores);
  } catch (const IoError& e) {
    return refuse(e.what(), again);
  }
}

}  // namespace

const std::vector<Vec3>* PoreWater::of_body(std::size_t body) const {
  const auto found = std::find(bodies.begin(), bodies.end(), body);
  return found == bodies.end() ? nullptr
                               : &particles[static_cast<std::size_t>(found - bodies.begin())];
}

std::optional<PoreWater> pore_water(const Model& model, Diagnostics& found, Relaxing how) {
  const std::optional<PoreBodies> pores = pore_bodies(model);
  if (!pores) {
    if (model.relaxation.file)
      found.warning("W133", model.place_of("relaxation.file"), "relaxation.file",
                    "no water of this deck starts in the pores of soil: the file is not used");
    return std::nullopt;
  }
  if (model.relaxation.file && how != Relaxing::anew) return stored(model, *pores, found);
  try {
    return fill(model, *pores, how == Relaxing::draft);
  } catch (const Error& e) {
    const std::string path = fmt::format("bodies[{}]", pores->bodies.front());
    found.error("E131", model.place_of(path), path, e.what());
    return std::nullopt;
  }
}

std::vector<double> expected_shares(const Model& model) {
  std::vector<double> out(model.bodies.size(), 1);
  const std::optional<PoreBodies> pores = pore_bodies(model);
  if (!pores) return out;
  const WaterTarget target(model);
  for (const std::size_t b : pores->bodies) {
    const Shape& shape = *model.bodies[b].shape;
    const Aabb box = shape.box();
    if (box.empty() || !box.lo.allFinite() || !box.hi.allFinite()) continue;
    const int n = model.dimension == 3 ? 16 : 64;
    double inside = 0, water = 0;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < (model.dimension == 3 ? n : 1); ++j)
        for (int i = 0; i < n; ++i) {
          Vec3 p = box.lo + (box.hi - box.lo).cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5) / n);
          if (model.dimension == 2) p.y() = 0;
          if (shape.bound(p) >= 0) continue;
          const double f = target.fraction(p);
          inside += 1;
          water += f >= 0 ? f : 1;
        }
    if (inside > 0) out[b] = water / inside;
  }
  return out;
}

StateFileKind relaxed_kind() { return {"relaxed water 1", "stored water"}; }

void put(const PoreWater& water, const std::string& depends, StateSink& out) {
  out.put_text("depends_on", depends);
  for (std::size_t b = 0; b < water.bodies.size(); ++b) {
    std::vector<double> flat;
    for (const Vec3& p : water.particles[b]) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
    out.put(fmt::format("positions/{}", b), flat, 3);
  }
  out.put("water_fraction", water.water_fraction);
  out.put("number_density", water.number_density);
  std::vector<double> rows;
  for (const RelaxationStep& s : water.history)
    rows.insert(rows.end(), {s.density_spread, s.density_mean, s.density_low, s.density_high,
                             s.mean_move, s.largest_move});
  out.put("history", rows, 6);
  out.put_number("volume", water.volume);
  out.put_number("water_density_spread", water.water_density_spread);
  out.put_count("moved", water.moved);
  out.put_count("interior", water.interior);
}

PoreWater take(const StateSource& in, const PoreBodies& pores) {
  PoreWater out;
  out.bodies = pores.bodies;
  out.from_file = true;
  for (std::size_t b = 0; b < pores.bodies.size(); ++b) {
    const std::string name = fmt::format("positions/{}", b);
    std::vector<double> flat(in.size(name));
    in.get(name, flat);
    std::vector<Vec3> at;
    for (std::size_t k = 0; k + 2 < flat.size(); k += 3)
      at.emplace_back(flat[k], flat[k + 1], flat[k + 2]);
    out.accepted += static_cast<Index>(at.size());
    out.particles.push_back(std::move(at));
  }
  out.water_fraction.resize(in.size("water_fraction"));
  in.get("water_fraction", out.water_fraction);
  out.number_density.resize(in.size("number_density"));
  in.get("number_density", out.number_density);
  std::vector<double> rows(in.size("history"));
  in.get("history", rows);
  for (std::size_t k = 0; k + 5 < rows.size(); k += 6)
    out.history.push_back(
        {rows[k], rows[k + 1], rows[k + 2], rows[k + 3], rows[k + 4], rows[k + 5]});
  out.volume = in.number("volume");
  out.water_density_spread = in.number("water_density_spread");
  out.moved = in.count("moved");
  out.interior = in.count("interior");
  return out;
}

}  // namespace sphgeo
