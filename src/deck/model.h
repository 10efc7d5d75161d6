#pragma once
// The validated deck as plain values in SI units, and the functions that make, write and describe
// it.

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.h"
#include "core/types.h"
#include "deck/interfaces.h"
#include "deck/motion.h"
#include "deck/schema.h"

namespace sphgeo {

/// A part of a solid body that does not move freely.
struct ClampedRegion {
  std::shared_ptr<const Shape> shape;  ///< the part of the body inside of it, at t = 0
  std::optional<Motion> motion;        ///< empty: it is fixed
  static Schema<ClampedRegion> schema();
};

/// A body of one material that fills a shape at t = 0.
struct Body {
  std::string name;
  std::string material;  ///< names an entry of `materials`
  std::shared_ptr<const Shape> shape;
  std::string filling = "auto";        ///< auto | lattice | relaxed
  std::array<Expression, 3> velocity;  ///< initial, m/s
  WordOrExpression pressure{"zero",
                            {}};  ///< initial: zero | hydrostatic | hydraulic_head | a formula (Pa)
  std::optional<Expression> head;  ///< piezometric level, for hydraulic_head, m
  std::optional<double> level;     ///< z of the free surface for hydrostatic; empty: the body's top
  std::string stress = "zero";     ///< of soil, initial: zero | geostatic
  std::optional<std::vector<Expression>>
      stress_tensor;                           ///< of soil, initial: xx, yy, zz, xy, yz, xz, Pa
  std::optional<double> lateral_stress_ratio;  ///< K0 of geostatic stress; empty: from the material
  std::optional<Expression> volume_fraction;   ///< of soil, initial; empty: the material's
  std::optional<Expression> porosity;          ///< 1 - volume_fraction, instead of it
  Expression saturation;                       ///< of soil, initial degree of saturation
  std::optional<double> spacing;               ///< of a solid, m; empty: the deck's resolution
  std::vector<ClampedRegion> clamped;          ///< of an elastic solid
  bool self_contact = false;                   ///< contact of an elastic solid with itself
  static Schema<Body> schema();
};

/// Choices of the numerical method; the defaults are those of the paper.
struct Numerics {
  std::string pair_precision = "single";  ///< single | double arithmetic in pair sums
  std::string pair_geometry = "frozen";   ///< frozen | current positions within an advection step
  double cfl_acoustic = 0.4;
  double cfl_advection = 0.2;
  double time_step_factor = 1;  ///< on all time steps
  double lattice_jitter = 0;    ///< of particle positions at t = 0, in spacings
  Index lattice_seed = 1;
  double advection_ratio_max = 5.5;
  double limiter = 3.0;                                ///< Eq. 63, water
  double transport_coefficient = 0.2;                  ///< alpha of Eq. 87
  std::string density_reinitialization = "summation";  ///< summation | shepard | none
  bool transport_velocity = true;
  std::string transport_at_surface = "none";  ///< none | tangential
  std::optional<double> h_factor_water;       ///< h / dp; empty: 1.8
  std::optional<double> h_factor_soil;        ///< h / dp; empty: 1.3
  std::optional<double> limiter_soil;         ///< xi^s of Eq. 54; empty: 20 times the dimension
  std::string soil_pair_geometry =
      "current";  ///< frozen | current positions within an advection step
  std::string soil_velocity_gradient = "corrected";            ///< corrected | plain sum of Eq. 55
  std::string volume_fraction_reinitialization = "summation";  ///< summation | none
  bool transport_velocity_soil = false;                        ///< Eq. 87 for soil
  std::optional<double> h_factor_solid;                        ///< h / dp; empty: 1.15
  double cfl_solid = 0.6;                                      ///< Eq. 94
  std::string solid_gradient =
      "linear";  ///< linear (Eq. 66) | quadratic: fields whose gradient is exact at rest
  std::string pore_water =
      "equal_mass";  ///< equal_mass | variable_mass | constant_volume, of water in soil
  double water_fraction_floor = 0.05;  ///< least n^w of Eq. 56
  bool transport_target_volume =
      true;  ///< V^tar of Eq. 88, or the volume at rest of clear water (Eq. 87)
  bool transport_projection = true;             ///< P^p of Eq. 88
  double transport_projection_threshold = 0.1;  ///< gamma_p of Eq. 89
  double max_lost_fraction = 0.01;
  double density_bound = 0.5;      ///< largest |rho / rho0 - 1| before the guard stops the run
  std::string outside = "remove";  ///< remove | stop
  std::optional<Vec3> domain_min;  ///< m; empty: from bodies and boundaries
  std::optional<Vec3> domain_max;
  static Schema<Numerics> schema();
};

/// The name by which `expect` refers to the history of the relaxation; no probe may have it.
inline constexpr const char* relaxation_probe = "relaxation";

/// Initial distribution of pore water (section 3.3).
struct Relaxation {
  int steps = 100;
  Index seed = 1;
  double tolerance = 0;  ///< mean displacement of a step over the target spacing that ends it
  std::string acceptance = "stratified";  ///< stratified | independent draws of the candidates
  std::optional<FilePath> file;           ///< a stored result
  static Schema<Relaxation> schema();
};

/// Particle frames for ParaView.
struct Frames {
  std::optional<double> every;        ///< s; empty: end_time / 20
  std::vector<std::string> fields;    ///< empty: the usual ones of each set
  std::string precision = "float32";  ///< float32 | float64
  static Schema<Frames> schema();
};

struct Output {
  Frames frames;
  std::optional<double> run_every;  ///< rows of run.csv, s; empty: end_time / 200
  double checkpoint_every = 600;    ///< wall time, s
  static Schema<Output> schema();
};

/// A result the deck claims. A probe's column is cut to [from, to] and
///   - reduced to one number: value = (reduced + shift) / scale; or
///   - with `reduce: curve`, compared with the table reference_csv: value = norm of
///     ((column + shift) / scale - y_scale * y) over the table's abscissae x_scale * x that lie in
///     [from, to], divided by the range (max - min) of y_scale * y there.
/// `within`: |value - reference| <= tolerance (times |reference| if relative); for a curve
/// value <= tolerance. `below`: value <= tolerance. `above`: value >= tolerance.
struct Expect {
  std::string name;
  std::string probe;  ///< "probe" (its first column) or "probe.column"
  std::string reduce = "last";
  std::optional<double> at;    ///< s, for `reduce: at`
  std::optional<double> from;  ///< s
  std::optional<double> to;    ///< s
  double shift = 0.0;          ///< added to the column before it is scaled
  double scale = 1.0;
  std::optional<double> reference;
  std::optional<FilePath> reference_csv;
  std::optional<std::string> x;  ///< column of the table; empty: the first
  std::optional<std::string> y;  ///< column of the table; empty: the second
  double x_scale = 1.0;
  double x_shift = 0.0;  ///< added to the scaled abscissae: another origin of time
  double y_scale = 1.0;
  std::string norm = "l2";  ///< l2 | max | relative_l2
  double tolerance = 0.0;
  std::string tolerance_kind = "relative";  ///< relative | absolute
  std::string measure = "within";           ///< within | below | above
  std::string source;
  static Schema<Expect> schema();
};

/// A whole deck.
struct Model {
  std::string title;
  int dimension = 3;
  double resolution = 0.0;                              ///< particle spacing dp, m
  Vec3 gravity{0.0, 0.0, -9.81};                        ///< m/s2
  std::optional<std::array<Expression, 3>> body_force;  ///< further acceleration, m/s2
  double end_time = 0.0;                                ///< s
  Variables variables;
  std::vector<std::string> include;  ///< already merged when the Model exists
  std::vector<std::shared_ptr<const MaterialSpec>> materials;
  std::vector<Body> bodies;
  std::vector<std::shared_ptr<const BoundarySpec>> boundaries;
  std::vector<std::shared_ptr<const ProbeSpec>> probes;
  Output output;
  Numerics numerics;
  Relaxation relaxation;
  std::vector<Expect> expect;
  std::vector<std::string> without;  ///< effects that are switched off

  Places places;         ///< where each key path stands
  Diagnostics warnings;  ///< of the reading

  /// Where a key path (or its nearest ancestor) stands in the deck.
  Place place_of(const std::string& path) const { return place_in(places, path); }
  /// The material of that name, or nullptr.
  const MaterialSpec* material(const std::string& material_name) const {
    for (const auto& m : materials)
      if (m->name == material_name) return m.get();
    return nullptr;
  }
  /// The liquid of the scene: the first water that a body is made of, else the first water at all;
  /// nullptr when there is none.
  const MaterialSpec* liquid() const;
  double frame_interval() const { return output.frames.every.value_or(end_time / 20); }
  double run_interval() const { return output.run_every.value_or(end_time / 200); }
  double probe_interval(const ProbeSpec& p) const { return p.every.value_or(end_time / 500); }
  static Schema<Model> schema();
};

/// Reads and checks a deck file ("-": standard input) with `--set` overrides.
/// Throws DeckError with every finding; warnings stay in the Model.
Model read_deck(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from a text; `name` stands for the file in findings, files are looked up in `folder`.
Model read_deck_text(const std::string& text, const std::vector<std::string>& overrides = {},
                     const std::string& name = "deck", const std::string& folder = ".");

/// The deck with all defaults filled in, readable again with an identical result.
std::string resolved_yaml(const Model& model);

/// JSON Schema (draft 7) of the deck language.
Json json_schema();

/// The resolved deck without the keys that may change on resume: what decides the result.
std::string decisive_yaml(const Model& model);

/// Hash of decisive_yaml().
std::string deck_hash(const Model& model);

/// Keys in which two texts of decisive_yaml() differ, as "numerics.limiter: 3 there, 5 here".
std::vector<std::string> differing_keys(const std::string& there, const std::string& here);

}  // namespace sphgeo
