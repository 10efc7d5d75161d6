#include <doctest/doctest.h>

#include "deck/registry.h"
#include "sample_types.h"

namespace sphgeo::sample {

Schema<Block> Block::schema() {
  Schema<Block> s("sample_block", "A block along the axes.");
  s.required("min", &Block::min, unit::length, "lower corner");
  s.required("max", &Block::max, unit::length, "upper corner").at_most(100);
  s.optional("axis", &Block::axis, unit::none, "axis of rotation").keep_y();
  s.optional("rounding", &Block::rounding, unit::length, "radius of the edges").above(0).below(0.1);
  s.optional("side", &Block::side, unit::none, "which side is solid")
      .choices({"inside", "outside"});
  s.optional("open", &Block::open, unit::none, "whether the top is open");
  s.optional("layers", &Block::layers, unit::none, "layers").at_least(1);
  s.optional("stops", &Block::stops, unit::time, "two times").items(2, 3).at_least(0);
  s.optional("roughness", &Block::roughness, unit::length, "height of bumps")
      .only_of("xyz")
      .at_least(0);
  s.check([](Block& b, CheckContext& c) {
    b.flat = c.dimension() == 2;
    if (!(b.min.z() < b.max.z())) c.error("max", "the block has no height", "raise max");
    if (b.layers > 5) c.warning("layers", "that is many layers");
  });
  return s;
}

Schema<Group> Group::schema() {
  Schema<Group> s("sample_group", "Several shapes.");
  s.required("of", &Group::of, unit::none, "the shapes").items(1);
  return s;
}

Schema<Liquid> Liquid::schema() {
  Schema<Liquid> s("sample_liquid", "A liquid.");
  s.optional("density", &Liquid::density, unit::density, "density at rest")
      .above(0)
      .equation("Eq. 26");
  s.optional("viscosity", &Liquid::viscosity, unit::viscosity, "dynamic viscosity").at_least(0);
  s.optional("friction_angle", &Liquid::friction_angle, unit::angle, "angle");
  s.optional("sound_speed", &Liquid::sound_speed, unit::speed, "speed of sound").above(0);
  return s;
}

Schema<Fence> Fence::schema() {
  Schema<Fence> s("sample_fence", "A fence.");
  s.optional("motion", &Fence::motion, unit::length, "displacement").only_of("t");
  s.optional("table", &Fence::table, unit::none, "a file");
  return s;
}

Schema<Gauge> Gauge::schema() {
  Schema<Gauge> s("sample_gauge", "A gauge.");
  s.required("at", &Gauge::at, unit::length, "its place");
  return s;
}

namespace {
const Register<Shape, Block> block{"sample_block"};
const Register<Shape, Group> group{"sample_group"};
const Register<MaterialSpec, Liquid> liquid{"sample_liquid"};
const Register<BoundarySpec, Fence> fence{"sample_fence"};
const Register<ProbeSpec, Gauge> gauge{"sample_gauge"};
}  // namespace

std::string good_deck() {
  return R"(title: Dam break
dimension: 2
resolution: 0.01 m
gravity: 9.81
end_time: 2 s
variables: {L: 0.4, H: 20 cm, W: 4*L}
materials:
  - {name: water, type: sample_liquid, density: 1 g/cm3}
bodies:
  - name: column
    material: water
    shape: {type: sample_block, min: [0, 0, 0], max: [L, 0.1, H]}
    velocity: [0.1*z, 0]
    pressure: hydrostatic
    level: 2*H + 0.1
boundaries:
  - {name: gate, type: sample_fence, motion: [0, 0, 0.5*t^2]}
probes:
  - {name: p1, type: sample_gauge, at: [W, 0.003], every: 1 ms}
output:
  frames: {every: 0.1, fields: [velocity]}
numerics:
  limiter: 3
expect:
  - {name: front, probe: p1.x, reduce: last, reference: 0.5, tolerance: 1 %}
)";
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = good_deck();
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::vector<Diagnostic> findings(const std::string& text,
                                 const std::vector<std::string>& overrides) {
  try {
    read_deck_text(text, overrides, "a.yaml");
    return {};
  } catch (const DeckError& e) {
    return e.diagnostics.items();
  }
}

std::string report(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    read_deck_text(text, overrides, "a.yaml");
    return {};
  } catch (const DeckError& e) {
    return e.diagnostics.render();
  }
}

}  // namespace sphgeo::sample

TEST_SUITE("deck") {
  TEST_CASE("the deck that other tests break is sound") {
    CHECK(sphgeo::sample::report(sphgeo::sample::good_deck()) == "");
  }
}
