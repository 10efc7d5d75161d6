#pragma once
// Reads the triangles of an STL file, text or binary.

#include <string>

#include "geometry/triangle_mesh.h"

namespace sphgeo {

/// All faces of the file with three corners of their own each (weld() joins them), lengths as in
/// the file. The normals of the file are ignored: the order of the corners decides. Throws IoError
/// when the file cannot be read, is truncated, has something other than finite triangles, or more
/// than ten million of them.
Triangles read_stl(const std::string& path);

/// Writes little-endian binary STL; throws IoError.
void write_stl(const std::string& path, const Triangles& mesh);

}  // namespace sphgeo
