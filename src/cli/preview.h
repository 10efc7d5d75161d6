#pragma once
// A picture of a scene before it runs.

#include <string>

#include "deck/model.h"
#include "sph/world.h"

namespace sphgeo {

/// Writes a PNG: particles in the colours of their sets (bodies of solids alternate), outlines of
/// the boundaries, and rings where probes are. Returns what the colours mean, as a line of text.
/// Throws IoError.
template <int Dim>
std::string write_preview(const Model& model, const World<Dim>& world, const std::string& path);

}  // namespace sphgeo
