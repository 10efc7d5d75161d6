#include "geometry/stl_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"

namespace sphgeo {

namespace {

constexpr std::size_t header_bytes = 80, face_bytes = 50;
constexpr std::size_t max_faces = 10'000'000;
constexpr std::uint64_t max_bytes = std::uint64_t{4} << 30;

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
  for (const Vec3& c : corners) {
    if (!c.allFinite())
      throw IoError(path, "triangle " + std::to_string(mesh.faces.size() + 1) +
                              " has a corner that is not finite");
    mesh.points.push_back(c);
  }
  mesh.faces.push_back({first, first + 1, first + 2});
}

Triangles read_binary(const std::string& bytes, const std::string& path) {
  const std::size_t count = read_u32(bytes.data() + header_bytes);
  const std::size_t expected = header_bytes + 4 + face_bytes * count;
  if (bytes.size() < expected)
    throw IoError(path, "the STL file is truncated: its header states " + std::to_string(count) +
                            " triangles (" + std::to_string(expected) + " bytes) but it has " +
                            std::to_string(bytes.size()) + " bytes");
  Triangles mesh;
  mesh.points.reserve(3 * std::min(count, max_faces));
  mesh.faces.reserve(std::min(count, max_faces));
  for (std::size_t f = 0; f < count; ++f) {
    const char* corner = bytes.data() + header_bytes + 4 + face_bytes * f + 12;  // after the normal
    std::array<Vec3, 3> c;
    for (Vec3& v : c) {
      v = Vec3(read_f32(corner), read_f32(corner + 4), read_f32(corner + 8));
      corner += 12;
    }
    add_face(mesh, c, path);
  }
  return mesh;
}

/// Splits a text into words and remembers the line for messages.
class Words {
 public:
  Words(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  double number() {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double v = 0.0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (status != std::errc() || end != word.data() + word.size())
      fail("expected a number, found '" + shortened(word, 60) + "'");
    return v;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(path_, "line " + std::to_string(line_) + ": " + what);
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_;
  std::string path_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Only `vertex` and `endfacet` matter; the name after `solid` may hold any words.
Triangles read_text(const std::string& text, const std::string& path) {
  Triangles mesh;
  Words words(text, path);
  std::array<Vec3, 3> corners;
  int have = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid" || word == "endsolid") {
      words.skip_line();
    } else if (word == "vertex") {
      if (have == 3) words.fail("a face with more than three corners");
      Vec3& c = corners[static_cast<std::size_t>(have++)];
      for (int k = 0; k < 3; ++k) c[k] = words.number();
    } else if (word == "endfacet") {
      if (have != 3) words.fail("a face with " + std::to_string(have) + " corners");
      add_face(mesh, corners, path);
      have = 0;
    }
  }
  if (have != 0) words.fail("the STL file is truncated: its last face is not closed");
  return mesh;
}

}  // namespace

Triangles read_stl(const std::string& path) {
  const std::string bytes = read_file(path, max_bytes);
  // Some binary files begin with "solid" too, so the size decides first, then the first words.
  const bool has_header = bytes.size() >= header_bytes + 4;
  const bool size_fits =
      has_header &&
      bytes.size() ==
          header_bytes + 4 + face_bytes * std::size_t{read_u32(bytes.data() + header_bytes)};
  const bool text =
      !size_fits && bytes.find("solid") < header_bytes && bytes.find("facet") != std::string::npos;
  if (!text && !has_header) throw IoError(path, "not an STL file");
  Triangles mesh = text ? read_text(bytes, path) : read_binary(bytes, path);
  if (mesh.faces.empty()) throw IoError(path, "the STL file has no triangles");
  return mesh;
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
