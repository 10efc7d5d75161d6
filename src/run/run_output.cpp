#include "run/run_output.h"

#include <algorithm>
#include <cmath>

#include "output/vtu.h"
#include "probes/probe.h"
#include "scene/build.h"
#include "scene/world_view.h"

namespace sphgeo {
namespace {

// Mean length of a number and its comma in a CSV file, and the columns of run.csv.
constexpr double cell_bytes = 19;
constexpr double run_csv_columns = 18;

// The text of a frame's file.
constexpr double head_bytes = 2000;

double count_of_every(double interval, double duration, double steps) {
  return std::min(std::floor(duration / interval + 1e-9) + 1, steps + 1);
}

/// Size of a frame of one set, and the memory that its composing takes beside it.
template <int Dim>
std::pair<double, double> frame_size(const Model& model, const ParticleSet<Dim>& set,
                                     const std::vector<Wish>& wishes) {
  const auto n = static_cast<std::size_t>(set.size());
  std::vector<VtuField> columns;
  columns.push_back({"id", "", 1, std::span<const std::uint64_t>(set.ids().data(), n)});
  // Real numbers are written as they are, so that any will do.
  const std::vector<double> any(3 * n);
  double vectors = 0;
  for (const Wish& w : wishes) {
    const auto it = set.fields().find(w.field);
    if (w.set != set.name() || w.who != "frames" || it == set.fields().end()) continue;
    const FieldSpec& spec = it->second->spec();
    if (spec.type == FieldType::identity || w.field == "position") continue;
    if (spec.type == FieldType::tag) {
      columns.push_back({w.field, "", 1, std::span<const std::int32_t>(set.tag(spec).data(), n)});
      continue;
    }
    const int components = spec.type == FieldType::vector ? 3 : 1;
    columns.push_back(
        {w.field, spec.unit.symbol, components,
         std::span<const double>(any.data(), n * static_cast<std::size_t>(components))});
    vectors += components == 3 && Dim == 2 ? 1 : 0;
  }
  VtuOptions options;
  options.time = 0;
  options.precision =
      model.output.frames.precision == "float64" ? VtuPrecision::float64 : VtuPrecision::float32;
  const auto& x = set.vector(fields::position);
  const auto bytes = static_cast<double>(vtu_bytes(
      VtuPoints(set.size(), [&](Index i) { return to_space<Dim>(x[i]); }), columns, options));
  return {bytes, vectors * 3 * sizeof(double) * static_cast<double>(n) + 0.2 * bytes};
}

}  // namespace

double boundaries_bytes(const BoundaryMesh& mesh, const Model& model) {
  if (mesh.part.empty()) return 0;
  return static_cast<double>(
      vtu_mesh_bytes(mesh.points, model.dimension, mesh.corners, {},
                     {{"part", "", 1, std::span<const std::int32_t>(mesh.part)}}));
}

template <int Dim>
RunOutput run_output(const Model& model, const World<Dim>& world, const std::vector<Wish>& wishes,
                     const BoundaryMesh& walls, double steps) {
  RunOutput out;
  out.frames = count_of_every(model.frame_interval(), model.end_time, steps);
  const double rows = count_of_every(model.run_interval(), model.end_time, steps);
  double cells = rows * run_csv_columns;
  out.observations = std::max(out.frames, rows);
  for (const auto& spec : model.probes) {
    const double n = count_of_every(model.probe_interval(*spec), model.end_time, steps);
    cells += n * static_cast<double>(1 + dynamic_cast<const Probe&>(*spec).columns(model).size());
    out.observations = std::max(out.observations, n);
  }
  out.samples_bytes = cell_bytes * cells;
  out.series_bytes = sizeof(double) * cells;
  double scratch = 0;
  for (const auto& set : world.sets())
    if (set->phase() != "wall") {
      const auto [bytes, buffers] = frame_size(model, *set, wishes);
      out.frame_bytes += bytes;
      out.frame_heads += std::min(bytes, head_bytes);
      scratch = std::max(scratch, buffers);
    }
  out.buffer_bytes = out.frame_bytes + scratch;
  for (const auto& set : world.sets()) out.checkpoint_bytes += saved_bytes(*set);
  out.walls_bytes = boundaries_bytes(walls, model) * (boundaries_move(model) ? out.frames : 1);
  return out;
}

template <int Dim>
void sample_probes(const Model& model, const World<Dim>& world) {
  const WorldView<Dim> view(model, world);
  for (const auto& spec : model.probes) {
    const auto& probe = dynamic_cast<const Probe&>(*spec);
    std::vector<std::optional<double>> values(probe.columns(model).size());
    probe.sample(view, values);
  }
}

template RunOutput run_output<2>(const Model&, const World<2>&, const std::vector<Wish>&,
                                 const BoundaryMesh&, double);
template RunOutput run_output<3>(const Model&, const World<3>&, const std::vector<Wish>&,
                                 const BoundaryMesh&, double);
template void sample_probes<2>(const Model&, const World<2>&);
template void sample_probes<3>(const Model&, const World<3>&);

}  // namespace sphgeo
