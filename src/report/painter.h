#pragma once
// Paints particles as discs and walls as lines: a 2D scene as the x-z plane, a 3D one obliquely
// from above.

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.h"
#include "report/picture.h"

namespace sphgeo {

/// From space (m) to pixels, by parallel projection.
struct View {
  bool flat = true;                  ///< no depth: what is painted later lies above
  Vec3 right{1, 0, 0}, up{0, 0, 1};  ///< of the picture plane
  Vec3 toward{0, -1, 0};             ///< to the eye
  double left = 0, top = 0;          ///< of the picture, m along right and up
  double scale = 1;                  ///< pixels per m
  int width = 1, height = 1;         ///< pixels

  double column(const Vec3& p) const { return (p.dot(right) - left) * scale; }
  double row(const Vec3& p) const { return (top - p.dot(up)) * scale; }
};

/// A view of a box (m; not empty, finite) that is at most so many pixels wide and high, with a
/// margin around it. `dimension` 2: the x-z plane; 3: from in front, the right and above.
View view_of(const Aabb& box, int dimension, int most_width, int most_height);

/// The region of a picture: the particles, and walls up to `reach` times the extent of the
/// particles beyond them. Either may be empty.
Aabb picture_box(const Aabb& particles, const Aabb& walls, double reach = 0.5);

/// Factor of the diameter of discs over this spacing (m): small ones overlap, since gaps of about a
/// pixel give moire patterns; large ones are shown separately.
double disc_cover(const View& view, double spacing);

/// Paints into a picture that begins transparent. Colours are numbers in the list given at the
/// start (at most `most_colors`); in 3D each of them is shaded.
class Painter {
 public:
  static constexpr int most_colors = 42;

  Painter(const View& view, std::vector<Color> colors);

  /// A straight line, `thickness` pixels wide. In 3D it lies behind all discs, so that the inside
  /// of a tank is visible.
  void line(const Vec3& a, const Vec3& b, double thickness, int color);
  /// Discs (balls in 3D) of one diameter (m), each with its colour. `nearer` (m) moves them towards
  /// the eye.
  void discs(std::span<const Vec3> centers, double diameter, std::span<const std::uint8_t> colors,
             double nearer = 0);
  /// A ring with a dot, in front of everything: the position of a probe.
  void mark(const Vec3& at, double radius, int color);

  /// The picture so far.
  Picture picture() const;

 private:
  static constexpr int shades = 6;

  void set(int column, int row, int color);
  int shade_at(int column, int row) const;

  View view_;
  std::vector<Color> colors_;
  std::vector<std::int16_t> color_;  ///< by pixel: -1 = nothing
  std::vector<float> depth_;         ///< by pixel, towards the eye, m; 3D only
  std::vector<float> light_;         ///< by pixel: of the balls' faces, 0..1; 3D only
  std::vector<std::int16_t> above_;  ///< marks: -1 = none
  double ball_ = 0;                  ///< largest diameter so far, m
};

/// The characteristic lines of a wall's surface: of a mesh of lines all, of
/// triangles those edges that belong to one face or lie between faces at more than 30 degrees. Two
/// corners each.
std::vector<std::pair<Index, Index>> outline(std::span<const Vec3> points, int corners_per_cell,
                                             std::span<const Index> corners);

}  // namespace sphgeo
