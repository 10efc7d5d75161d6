#pragma once
// Small types that only the deck tests register, and helpers to read decks with them.

#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "deck/model.h"

namespace sphgeo::sample {

struct Block final : Shape {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  Vec3 axis{0, 1, 0};
  std::optional<double> rounding;
  std::string side = "inside";
  bool open = false;
  int layers = 2;
  std::vector<double> stops{0.5, 1.5};
  Expression roughness{0.25};
  bool flat = false;
  static Schema<Block> schema();
  double signed_distance(const Vec3& at) const override { return at.x() - max.x(); }
  Aabb box() const override { return {min, max}; }
};

struct Group final : Shape {
  std::vector<std::shared_ptr<const Shape>> of;
  static Schema<Group> schema();
  double signed_distance(const Vec3& at) const override { return of.front()->signed_distance(at); }
  Aabb box() const override { return of.front()->box(); }
};

struct Liquid final : MaterialSpec {
  double density = 1000.0;
  double viscosity = 1e-3;
  double friction_angle = 0.5;
  std::optional<double> sound_speed;
  std::string phase() const override { return "water"; }
  static Schema<Liquid> schema();
};

struct Fence final : BoundarySpec {
  std::array<Expression, 3> motion;
  std::optional<FilePath> table;
  static Schema<Fence> schema();
};

struct Gauge final : ProbeSpec {
  Vec3 at = Vec3::Zero();
  static Schema<Gauge> schema();
};

/// A sound deck in 2D that the tests break in turn; line numbers count from 1.
std::string good_deck();

/// `good_deck` with one text replaced; fails the test when `from` does not occur.
std::string with(const std::string& from, const std::string& to);

/// What reading a deck reports; empty for a sound deck.
std::vector<Diagnostic> findings(const std::string& text,
                                 const std::vector<std::string>& overrides = {});

/// The same as the user sees it.
std::string report(const std::string& text, const std::vector<std::string>& overrides = {});

}  // namespace sphgeo::sample
