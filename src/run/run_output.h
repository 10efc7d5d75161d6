#pragma once
// Forecast of a run's output, and its cost.

#include <string>
#include <vector>

#include "deck/model.h"
#include "plan/plan.h"
#include "run/boundary_mesh.h"

namespace sphgeo {

/// Number of samples of a run, and the size of its output.
struct RunOutput {
  double frames = 0;            ///< number of
  double observations = 0;      ///< number of times that any probe, row or frame is due
  double samples_bytes = 0;     ///< of all rows of the probes and of run.csv, in the files
  double series_bytes = 0;      ///< the same in memory
  double frame_bytes = 0;       ///< of one frame of all sets but walls
  double frame_heads = 0;       ///< of that, the part independent of the number of particles
  double walls_bytes = 0;       ///< of all frames of the boundaries
  double buffer_bytes = 0;      ///< memory taken until a frame is written
  double checkpoint_bytes = 0;  ///< of one checkpoint; until it is written it exists in memory too
};

/// Of a run of `steps` advection steps; `walls` are its boundaries. Composes one frame to know its
/// size.
template <int Dim>
RunOutput run_output(const Model& model, const World<Dim>& world, const std::vector<Wish>& wishes,
                     const BoundaryMesh& walls, double steps);

/// Bytes of a set's part of a checkpoint.
template <int Dim>
double saved_bytes(const ParticleSet<Dim>& set) {
  double sum = 0;
  for (const auto& [name, field] : set.fields())
    if (field->spec().lifetime != Lifetime::derived)
      sum += static_cast<double>(field->value_bytes());
  return sum;
}

/// Bytes of a frame of the boundaries; 0 without any.
double boundaries_bytes(const BoundaryMesh& mesh, const Model& model);

/// Samples all probes once to measure the time.
template <int Dim>
void sample_probes(const Model& model, const World<Dim>& world);

}  // namespace sphgeo
