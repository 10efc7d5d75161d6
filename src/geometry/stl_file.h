#pragma once
// Reads the triangles of an STL file, text or binary.

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace sphgeo {

/// A surface as read, and what was odd about its file.
struct StlSurface {
  Triangles mesh;
  std::vector<std::string> remarks;  ///< sentences for the user
};

/// All faces of the file with three corners of their own each (weld() joins them), lengths as in
/// the file. The normals of the file are ignored: the order of the corners decides. Keywords of a
/// text may be in capitals and its lines may end in CR. A binary file whose header counts 0 or
/// 2^32 - 1 triangles has as many as its size holds, and bytes behind its triangles are left out;
/// both are remarked. Throws IoError when the file cannot be read, is truncated, has something
/// other than finite triangles, or more than ten million of them: that within seconds, from its
/// size.
StlSurface read_stl(const std::string& path);

/// Writes little-endian binary STL; throws IoError.
void write_stl(const std::string& path, const Triangles& mesh);

}  // namespace sphgeo
