#pragma once
// One frame: the particles of a set, or the surfaces of the boundaries, as a VTU file in memory.

#include <string>
#include <vector>

#include "deck/model.h"
#include "output/vtu.h"
#include "particles/particle_set.h"
#include "run/boundary_mesh.h"

namespace sphgeo {

/// Ids and the named fields of a set; names without a field are left out.
template <int Dim>
FileImage set_frame(const ParticleSet<Dim>& set, const std::vector<std::string>& names,
                    const VtuOptions& options);

/// The surfaces of the boundaries of a model at a time (s).
FileImage boundary_frame(const BoundaryMesh& mesh, const Model& model, double time);

}  // namespace sphgeo
