// Decks and `--set` overrides: the whole reading up to the model, without running the scene.

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "boundaries/boundary.h"
#include "core/error.h"
#include "deck/model.h"
#include "targets.h"

namespace sphgeo::fuzz {

namespace {

/// A sound deck that `--set` overrides change.
constexpr const char* base_deck = R"(title: base
dimension: 3
resolution: 0.1 m
end_time: 1 s
variables: {L: 1.5, depth: 0.5*L, n: 4}
materials: [{name: water, type: water, density: 1000}]
bodies:
  - {name: column, material: water, shape: {type: box, min: [0, 0, 0], max: [L, depth, 1]},
      pressure: hydrostatic}
  - name: drop
    material: water
    velocity: [0, 0, -2*z]
    shape: {type: union, of: [{type: sphere, center: [0, 0, 3], radius: 0.3}, {type: stl,
        file: ball.stl, translate: [0, 0, 4]}]}
boundaries:
  - {name: tank, type: tank, min: [-1, -1, 0], max: [3, 2, 6], open: [top],
      motion: {displacement: [0.01*sin(t), 0, 0]}}
  - {name: bed, type: wall, shape: {type: height_field, file: heights.csv, spacing: 0.5,
      bottom: -1}}
probes:
  - {name: p1, type: pressure, at: [0, 0, 0.1], every: 1 ms}
  - {name: energy, type: energy}
numerics: {limiter: 3}
output: {frames: {every: 0.1 s, fields: [velocity]}}
expect:
  - {name: kept, probe: energy.kinetic, reduce: last, reference: 1, tolerance: 5 %}
)";

void use_shape(const Shape& shape) {
  const Aabb box = shape.box();
  for (const Vec3& at :
       {Vec3(0, 0, 0), Vec3(0.3, 0, -0.7), Vec3(box.lo), Vec3(0.5 * (box.lo + box.hi))})
    if (at.allFinite()) shape.signed_distance(at);
}

/// What the program does with a model before it builds the scene.
void use(const Model& model) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    require(body.shape != nullptr && model.material(body.material) != nullptr,
            "every body of a sound deck has a shape and a material");
    use_shape(*body.shape);
    Diagnostics found;
    CheckContext context(found, model.places, fmt::format("bodies[{}].shape", b), model.dimension,
                         model.resolution);
    body.shape->inspect(context);
    for (const Expression& v : body.velocity) v(Vec3(0.1, 0.2, 0.3), 0.0);
  }
  for (const auto& spec : model.boundaries) {
    const auto* wall = dynamic_cast<const WallBoundary*>(spec.get());
    if (wall == nullptr) continue;
    if (wall->motion) wall->motion->velocity(Vec3(0.1, 0.2, 0.3), 0.5);
    if (const auto solid = wall->solid({model.resolution, 4 * model.resolution, model.dimension}))
      use_shape(*solid);
  }
}

void check_findings(const DeckError& e) {
  require(e.diagnostics.has_errors(), "a refused deck has an error");
  for (const Diagnostic& d : e.diagnostics.items()) {
    require(!d.place.file.empty(), "every finding names its file: " + d.message);
    require(!d.message.empty() && d.message.size() < 20000,
            "a finding is a sentence: " + d.message);
  }
  require(e.diagnostics.render(true).size() < (std::size_t{1} << 20),
          "a report has a bounded length");
}

void read(const std::string& text, const std::vector<std::string>& overrides) {
  Model model;
  try {
    model = read_deck_text(text, overrides, "deck.yaml", SPHGEO_FUZZ_FILES);
  } catch (const DeckError& e) {
    check_findings(e);
    return;
  }
  use(model);
  const std::string resolved = resolved_yaml(model);
  try {
    const Model again = read_deck_text(resolved, {}, "resolved.yaml", SPHGEO_FUZZ_FILES);
    require(resolved_yaml(again) == resolved,
            "a resolved deck resolves to itself:\n" + resolved + "\nnot\n" + resolved_yaml(again));
    require(deck_hash(again) == deck_hash(model), "a resolved deck has the hash of its deck");
  } catch (const DeckError& e) {
    require(false, "a resolved deck can be read:\n" + resolved + e.diagnostics.render());
  }
}

}  // namespace

void run_deck(std::string_view input) { read(std::string(input), {}); }

/// One override a line.
void run_set(std::string_view input) {
  constexpr std::size_t most = 16;
  std::vector<std::string> overrides;
  std::istringstream lines{std::string(input)};
  for (std::string line; overrides.size() < most && std::getline(lines, line);)
    overrides.push_back(line);
  read(base_deck, overrides);
}

}  // namespace sphgeo::fuzz
