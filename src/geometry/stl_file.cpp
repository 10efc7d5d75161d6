#include "geometry/stl_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "core/words.h"

namespace sphgeo {

namespace {

constexpr std::size_t header_bytes = 80, face_bytes = 50;
constexpr std::size_t max_faces = 10'000'000;
constexpr std::uint64_t max_text_bytes = std::uint64_t{2} << 30,
                        max_bytes =
                            max_text_bytes;  // of ten million faces: 500 MB, or more in text

std::uint32_t read_u32(const char* at) {
  std::uint32_t v = 0;
  for (int k = 3; k >= 0; --k) v = v << 8 | static_cast<unsigned char>(at[k]);  // little-endian
  return v;
}

float read_f32(const char* at) {
  const std::uint32_t bits = read_u32(at);
  float v = 0.0f;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}

void add_face(Triangles& mesh, const std::array<Vec3, 3>& corners, const std::string& path) {
  if (mesh.faces.size() >= max_faces)
    throw IoError(path,
                  "more than " + std::to_string(max_faces) + " triangles: use a coarser surface");
  const auto first = static_cast<std::int32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), corners.begin(), corners.end());
  mesh.faces.push_back({first, first + 1, first + 2});
}

// How many triangles a binary file has: what its header counts, but for writers that do not know
// it beforehand and leave 0 or 2^32 - 1 there.
std::size_t faces_of(std::uint64_t size, std::uint32_t stated, const std::string& path,
                     std::vector<std::string>* remarks = nullptr) {
  const std::uint64_t room = (size - header_bytes - 4) / face_bytes;
  std::uint64_t count = stated;
  if ((stated == 0 || stated == 0xffffffffU) && room > 0) {
    count = room;
    if (remarks)
      remarks->push_back("its header counts " + std::to_string(stated) +
                         " triangles; by its size it has " + std::to_string(count));
  }
  if (count > max_faces)
    throw IoError(path, std::to_string(count) + " triangles are more than " +
                            std::to_string(max_faces) + ": use a coarser surface");
  const std::uint64_t expected = header_bytes + 4 + face_bytes * count;
  if (size < expected)
    throw IoError(path, "the STL file is truncated: its header states " + std::to_string(count) +
                            " triangles (" + std::to_string(expected) + " bytes) but it has " +
                            std::to_string(size) + " bytes");
  if (size > expected && remarks)
    remarks->push_back(std::to_string(size - expected) +
                       " bytes behind its last triangle were left out");
  return static_cast<std::size_t>(count);
}

Triangles read_binary(const std::string& bytes, std::size_t count, const std::string& path) {
  Triangles mesh;
  mesh.points.reserve(3 * count);
  mesh.faces.reserve(count);
  for (std::size_t f = 0; f < count; ++f) {
    const char* corner = bytes.data() + header_bytes + 4 + face_bytes * f + 12;  // after the normal
    std::array<Vec3, 3> c;
    for (Vec3& v : c) {
      v = Vec3(read_f32(corner), read_f32(corner + 4), read_f32(corner + 8));
      if (!v.allFinite())
        throw IoError(path,
                      "triangle " + std::to_string(f + 1) + " has a corner that is not finite");
      corner += 12;
    }
    add_face(mesh, c, path);
  }
  return mesh;
}

/// Only `vertex` and `endfacet` matter; the name after `solid` may hold any words.
Triangles read_text(std::string_view text, const std::string& path) {
  Triangles mesh;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
  Words words(text, path);
  const std::string_view first = words.peek();
  if (first.empty()) throw IoError(path, "not an STL file: it is empty");
  if (lower_case(first) != "solid")
    throw IoError(path, "not an STL file: it begins with '" + shortened(first, 40) +
                            "', not with 'solid' as a text, and has no header of a binary");
  std::array<Vec3, 3> corners;
  int have = 0;
  for (std::string_view next = words.next(); !next.empty(); next = words.next()) {
    const std::string word = lower_case(next);
    if (word == "solid" || word == "endsolid") {
      words.skip_line();
    } else if (word == "vertex") {
      if (have == 3) words.fail("a face with more than three corners");
      Vec3& c = corners[static_cast<std::size_t>(have++)];
      for (int k = 0; k < 3; ++k) c[k] = words.number();
      if (!c.allFinite()) words.fail("a corner that is not finite");
    } else if (word == "endfacet") {
      if (have != 3) words.fail("a face with " + std::to_string(have) + " corners");
      add_face(mesh, corners, path);
      have = 0;
    }
  }
  if (have != 0) words.fail("the STL file is truncated: its last face is not closed");
  return mesh;
}

// Whether the file is text: binary ones may begin with "solid" too, but the size that they count,
// or bytes that no text has, tell them apart.
bool is_text(std::string_view begin, std::uint64_t size) {
  if (begin.size() >= header_bytes + 4 &&
      size == header_bytes + 4 + face_bytes * std::uint64_t{read_u32(begin.data() + header_bytes)})
    return false;
  return std::none_of(begin.begin(), begin.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' && !(c >= '\t' && c <= '\r');
  });
}

}  // namespace

StlSurface read_stl(const std::string& path) {
  const std::string begin = read_beginning(path, 4096);
  std::error_code unknown;
  const std::uint64_t size = std::filesystem::file_size(path, unknown);
  StlSurface surface;
  if (is_text(begin, size)) {
    if (!unknown && size > max_text_bytes)
      throw IoError(path, std::to_string(size >> 20) +
                              " MB of text are too heavy: save it as binary STL, or use a coarser "
                              "surface");
    surface.mesh = read_text(read_file(path, max_text_bytes), path);
  } else {
    if (begin.size() < header_bytes + 4) throw IoError(path, "not an STL file");
    const std::uint32_t stated = read_u32(begin.data() + header_bytes);
    if (!unknown) faces_of(size, stated, path);
    const std::string bytes = read_file(path, max_bytes);
    surface.mesh = read_binary(bytes, faces_of(bytes.size(), stated, path, &surface.remarks), path);
  }
  if (surface.mesh.faces.empty()) throw IoError(path, "the STL file has no triangles");
  return surface;
}

void write_stl(const std::string& path, const Triangles& mesh) {
  std::string bytes(header_bytes, ' ');
  auto put_u32 = [&](std::uint32_t v) {
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<char>(v >> 8 * k & 0xff));
  };
  auto put_vector = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) {
      const auto f = static_cast<float>(v[k]);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &f, sizeof bits);
      put_u32(bits);
    }
  };
  put_u32(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const auto& f : mesh.faces) {
    const Vec3& a = mesh.points[static_cast<std::size_t>(f[0])];
    const Vec3& b = mesh.points[static_cast<std::size_t>(f[1])];
    const Vec3& c = mesh.points[static_cast<std::size_t>(f[2])];
    const Vec3 n = (b - a).cross(c - a);
    put_vector(n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero()));
    for (const Vec3* v : {&a, &b, &c}) put_vector(*v);
    bytes.append(2, '\0');
  }
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.flush();
  if (!out) throw IoError(path, std::string("cannot write the STL file: ") + std::strerror(errno));
}

}  // namespace sphgeo
