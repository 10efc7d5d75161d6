#pragma once
// One frame: the particles of a set, or the surfaces of the boundaries, as a VTU file.

#include <string>
#include <vector>

#include "deck/model.h"
#include "output/vtu.h"
#include "particles/particle_set.h"

namespace sphgeo {

/// Writes ids and the named fields of a set; names without a field are left out. Throws IoError.
template <int Dim>
void write_set_frame(const std::string& path, const ParticleSet<Dim>& set,
                     const std::vector<std::string>& names, const VtuOptions& options);

/// Writes the surfaces of all boundaries at a time (s). Throws IoError.
void write_boundary_frame(const std::string& path, const Model& model, double time);

}  // namespace sphgeo
