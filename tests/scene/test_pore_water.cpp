#include "scene/pore_water.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "output/temporary_folder.h"
#include "scene/build.h"
#include "scene/cross_check.h"
#include "scene/particle_count.h"

using namespace sphgeo;

namespace {

constexpr const char* materials =
    "materials:\n"
    "  - {name: w, type: water}\n"
    "  - {name: s, type: soil, density: 2650, youngs_modulus: 1e7, friction_angle: 0.5, skeleton: "
    "fixed}\n";

const std::string square = "{type: box, min: [0, 0, 0], max: [1, 1, 1]}";

std::string deck(int dim, double dp, const std::string& water, const std::string& soil,
                 const std::string& more = "") {
  return fmt::format(
      "dimension: {}\nresolution: {}\nend_time: 1\n{}bodies:\n  - {{name: water, material: w, "
      "shape: {}}}\n{}{}",
      dim, dp, materials, water, soil, more);
}
std::string soil(const std::string& shape, const std::string& porosity) {
  return "  - {name: bed, material: s, shape: " + shape + ", porosity: \"" + porosity + "\"}\n";
}

PoreWater relaxed(const std::string& text, const std::vector<std::string>& set = {}) {
  const Model model = read_deck_text(text, set, "deck", SPHGEO_SOURCE_DIR "/share/assets");
  Diagnostics found;
  const std::optional<PoreWater> water = pore_water(model, found);
  REQUIRE_MESSAGE(!found.has_errors(), found.render());
  REQUIRE(water.has_value());
  return *water;
}

/// The particles within half a spacing of those that the volume of water makes, dp^dim each.
void check_count(const PoreWater& w, double volume, double dp, int dim) {
  CHECK(std::abs(static_cast<double>(w.accepted) - volume / std::pow(dp, dim)) <= 1.0);
  std::size_t n = 0;
  for (const auto& p : w.particles) n += p.size();
  CHECK(static_cast<Index>(n) == w.accepted);
}

double spread(const PoreWater& w) { return w.history.back().density_spread; }

/// Water in a horizontal slice, in particles.
double particles_between(const PoreWater& w, double low, double high) {
  double n = 0;
  for (const auto& some : w.particles)
    for (const Vec3& p : some) n += p.z() >= low && p.z() < high;
  return n;
}

std::vector<std::string> pore_findings(const std::string& text) {
  const Model model = read_deck_text(text);
  Diagnostics found;
  (void)pore_water(model, found);
  std::vector<std::string> ids;
  for (const Diagnostic& d : found.items()) ids.push_back(d.id);
  return ids;
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("uniform porosity: mass, spread and place of the water") {
    const PoreWater w = relaxed(deck(2, 0.025, square, soil(square, "0.5")));
    check_count(w, 0.5, 0.025, 2);
    CHECK(w.history.size() == 101);
    CHECK(spread(w) < 0.015);
    CHECK(spread(w) < 0.3 * w.history.front().density_spread);
    CHECK(w.history.back().density_mean == doctest::Approx(1).epsilon(0.02));
    CHECK(particles_between(w, 0, 0.5) == doctest::Approx(0.25 / (0.025 * 0.025)).epsilon(0.03));
    // Eq. 86: nothing is nearer to the surface than half a spacing of clear water.
    for (const Vec3& p : w.particles[0]) {
      CHECK(std::min({p.x(), p.z(), 1 - p.x(), 1 - p.z()}) >= 0.499 * 0.025);
      CHECK(p.y() == 0);
    }
  }

  TEST_CASE("linear porosity keeps its profile") {
    const PoreWater w = relaxed(deck(2, 0.02, square, soil(square, "0.2 + 0.3*z")));
    check_count(w, 0.35, 0.02, 2);
    CHECK(spread(w) < 0.015);
    for (const double z : {0.1, 0.3, 0.5, 0.7})
      CHECK(particles_between(w, z, z + 0.2) * 0.0004 ==
            doctest::Approx(0.2 * (0.2 + 0.3 * (z + 0.1))).epsilon(0.06));
  }

  TEST_CASE("a step from clear water to pores within one body") {
    const std::string lower = "{type: box, min: [0, 0, 0], max: [1, 1, 0.5]}";
    const PoreWater w = relaxed(deck(2, 0.02, square, soil(lower, "0.5")));
    check_count(w, 0.75, 0.02, 2);
    CHECK(spread(w) < 0.03);
    CHECK(particles_between(w, 0, 0.5) == doctest::Approx(0.25 / 0.0004).epsilon(0.02));
    // Far above the soil the lattice is as it was.
    CHECK(w.moved < w.accepted);
    double lattice = 0;
    for (const Vec3& p : w.particles[0])
      lattice += p.z() > 0.8 && std::abs(p.z() / 0.02 - std::floor(p.z() / 0.02) - 0.5) < 1e-9;
    CHECK(lattice == 500);
    // A soil surface between two layers of the lattice.
    const PoreWater odd = relaxed(
        deck(2, 0.02, square, soil("{type: box, min: [0, 0, 0], max: [1, 1, 0.5067]}", "0.5")));
    check_count(odd, 1 - 0.5 * 0.5067, 0.02, 2);
    CHECK(spread(odd) < 0.03);
    // The same jump in a formula: summed over parts of a twelfth of a cell.
    const PoreWater formula =
        relaxed(deck(2, 0.02, square, soil(square, "z < 0.5 ? 0.5 : 1 - 1e-9")));
    check_count(formula, 0.75, 0.02, 2);
  }

  TEST_CASE("two bodies of water are one where they touch") {
    const std::string text = deck(
        2, 0.025, "{type: box, min: [0, 0, 0], max: [1, 1, 0.5]}",
        soil("{type: box, min: [0, 0, 0], max: [1, 1, 0.5]}", "0.5") +
            "  - {name: above, material: w, shape: {type: box, min: [0, 0, 0.5], max: [1, 1, 1]}}\n"
            "  - {name: elsewhere, material: w, shape: {type: box, min: [2, 0, 0], max: [2.5, 1, "
            "0.5]}}\n");
    const PoreWater w = relaxed(text);
    CHECK(w.bodies == std::vector<std::size_t>{0, 2});
    check_count(w, 0.75, 0.025, 2);
    CHECK(spread(w) < 0.03);
    Diagnostics found;
    const Model model = read_deck_text(text);
    const Scene<2> scene = build_scene<2>(model, found);
    check_scene(scene, found);
    CHECK_MESSAGE(!found.has_errors(), found.render());
    CHECK(scene.world->set("water").size() == w.accepted + 400);
    CHECK(count_of(expected_particles(model), "water") == doctest::Approx(1600).epsilon(0.03));
  }

  TEST_CASE("three dimensions, and a surface from an STL file") {
    const PoreWater w =
        relaxed(deck(3, 0.06, "{type: box, min: [0, 0, 0], max: [0.96, 0.96, 0.96]}",
                     soil(square, "0.2 + 0.3*z"), "relaxation: {steps: 60}\n"));
    check_count(w, 0.96 * 0.96 * (0.2 * 0.96 + 0.15 * 0.96 * 0.96), 0.06, 3);
    CHECK(spread(w) < 0.03);
    const Model ball =
        read_deck_text(deck(3, 0.1, "{type: stl, file: ball.stl}",
                            soil("{type: half_space, point: [0, 0, 0], normal: [0, 0, 1]}", "0.5")),
                       {}, "deck", SPHGEO_SOURCE_DIR "/share/assets");
    const Aabb box = ball.bodies[0].shape->box();
    // A twentieth of its width, whatever the asset measures.
    const double dp = (box.hi.x() - box.lo.x()) / 20;
    const double middle = 0.5 * (box.lo.z() + box.hi.z());
    const std::string text = deck(
        3, dp, "{type: stl, file: ball.stl}",
        soil(fmt::format("{{type: box, min: [-100, -100, -100], max: [100, 100, {}]}}", middle),
             "0.5"),
        "relaxation: {steps: 60}\n");
    const PoreWater s = relaxed(text);
    const auto* surface = dynamic_cast<const Shape*>(ball.bodies[0].shape.get());
    REQUIRE(surface);
    // Volume on a fine lattice, both halves alike.
    double volume = 0;
    const int n = 80;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const Vec3 p =
              box.lo + (box.hi - box.lo).cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5) / n);
          if (surface->signed_distance(p) < 0)
            volume += (p.z() < middle ? 0.5 : 1) * (box.hi - box.lo).prod() / (n * n * n);
        }
    CHECK(static_cast<double>(s.accepted) * std::pow(dp, 3) ==
          doctest::Approx(volume).epsilon(2e-3));
    CHECK(std::abs(s.mass_error(std::pow(dp, 3))) <= 0.5);
    CHECK(spread(s) < 0.03);
    double above = 0;
    for (const Vec3& p : s.particles[0]) {
      CHECK(surface->signed_distance(p) < -0.4 * dp);
      above += p.z() > middle;
    }
    CHECK(above / static_cast<double>(s.accepted) == doctest::Approx(2.0 / 3).epsilon(0.02));
  }

  TEST_CASE("the same bits for any number of threads, others for another seed") {
    const std::string text =
        deck(2, 0.04, square, soil(square, "0.3 + 0.2*x"), "relaxation: {steps: 20}\n");
    const PoreWater two = relaxed(text), other = relaxed(text, {"relaxation.seed=2"});
    set_threads(1);
    const PoreWater one = relaxed(text);
    set_threads(4);
    const PoreWater four = relaxed(text);
    set_threads(2);
    for (const PoreWater* w : {&one, &four}) {
      REQUIRE(w->accepted == two.accepted);
      CHECK(std::memcmp(w->particles[0].data(), two.particles[0].data(),
                        two.particles[0].size() * sizeof(Vec3)) == 0);
      CHECK(std::memcmp(w->history.data(), two.history.data(),
                        two.history.size() * sizeof(RelaxationStep)) == 0);
    }
    CHECK(other.accepted == two.accepted);
    CHECK((other.particles[0][0] - two.particles[0][0]).norm() > 0);
  }

  TEST_CASE("a stored result gives the same scene, and no other deck takes it") {
    const test::TemporaryFolder folder;
    const std::string file = folder.path() + "/relaxed.h5";
    const std::string text = deck(2, 0.05, square, soil(square, "n0*z + 0.5"),
                                  "variables: {n0: 0.1, unused: 1}\nrelaxation: {steps: 10}\n");
    const Model model = read_deck_text(text);
    Diagnostics found;
    const PoreWater water = *pore_water(model, found);
    StateFileWriter out(relaxed_kind());
    put(water, depends_on(model, *pore_bodies(model)), out);
    out.write(file, "");
    const auto with = [&](std::vector<std::string> set, const std::string& of) {
      set.push_back("relaxation.file=" + file);
      const Model other = read_deck_text(of, set);
      Diagnostics problems;
      const std::optional<PoreWater> taken = pore_water(other, problems);
      if (taken) {
        CHECK(taken->from_file);
        CHECK(std::memcmp(taken->particles[0].data(), water.particles[0].data(),
                          water.particles[0].size() * sizeof(Vec3)) == 0);
        CHECK(taken->history.size() == 11);
        CHECK(taken->volume == water.volume);
      }
      CHECK(problems.has_errors() != taken.has_value());
      return problems.items().empty() ? std::string()
                                      : problems.items()[0].id + " " + problems.items()[0].message;
    };
    CHECK(with({}, text) == "");
    CHECK(with({"unused=3", "gravity=1", "materials[0].density=900"}, text) == "");
    const auto refused = [&](std::vector<std::string> set, const std::string& names) {
      const std::string why = with(std::move(set), text);
      CHECK(why.starts_with("E132"));
      CHECK_MESSAGE(why.find(names) != std::string::npos, why);
    };
    refused({"resolution=0.04"}, "resolution: 0.05 there, 0.04 here");
    refused({"n0=0.2"}, "variables.n0: 0.1 there, 0.2 here");
    refused({"relaxation.seed=3"}, "relaxation.seed: 1 there, 3 here");
    refused({"relaxation.steps=11"}, "relaxation.steps");
    refused({"dimension=3"}, "dimension: 2 there, 3 here");
    refused({"bodies[0].shape.max=[1, 1, 0.9]"}, "water[0].shape.max");
    refused({"bodies[1].shape.max=[1, 1, 0.9]"}, "soil[0].shape.max");
    refused({"bodies[1].porosity=0.4"}, "soil[0].porosity");
  }

  TEST_CASE("what cannot be filled is refused; dry soil and water beside it are no case for it") {
    CHECK(pore_findings(deck(2, 0.05, square, soil(square, "0.01"))) ==
          std::vector<std::string>{"E131"});
    CHECK(pore_findings(deck(2, 0.05, square, soil(square, "1/(x-x)"))) ==
          std::vector<std::string>{"E131"});
    CHECK(pore_findings(deck(2, 0.05, square, soil(square, "1.5"))) ==
          std::vector<std::string>{"E131"});
    const std::string beside =
        deck(2, 0.05, square, soil("{type: box, min: [1, 0, 0], max: [2, 1, 1]}", "0.5"));
    CHECK(pore_findings(beside).empty());
    CHECK_FALSE(pore_bodies(read_deck_text(beside)).has_value());
    CHECK(expected_shares(read_deck_text(beside)) == std::vector<double>{1, 1});
  }
}
