#include "materials/hyperelastic.h"

#include <doctest/doctest.h>

#include "core/hash.h"

using namespace sphgeo;

namespace {

Mat3 some_gradient(double size) {
  Mat3 g;
  for (int k = 0; k < 9; ++k)
    g(k / 3, k % 3) = size * (2 * random_uniform(3, static_cast<std::uint64_t>(k)) - 1);
  return g;
}

}  // namespace

TEST_SUITE("materials") {
  TEST_CASE("the stress of a hyperelastic law is the derivative of its energy") {
    for (const bool neo_hookean : {true, false}) {
      const Hyperelastic law{4e5, 9e5, neo_hookean};
      const Mat3 g = some_gradient(0.2);
      // P = dW / dF = F S.
      const Mat3 piola = (Mat3::Identity() + g) * second_piola(g, law);
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          const double d = 1e-6;
          Mat3 up = g, down = g;
          up(k, l) += d;
          down(k, l) -= d;
          const double slope =
              (strain_energy_density(up, law) - strain_energy_density(down, law)) / (2 * d);
          CHECK(slope == doctest::Approx(piola(k, l)).epsilon(1e-6));
        }
    }
  }

  TEST_CASE("small strains give Hooke's law, and tiny ones lose no digits") {
    for (const bool neo_hookean : {true, false})
      for (const double size : {1e-6, 1e-12}) {
        const Hyperelastic law{4e5, 9e5, neo_hookean};
        const Mat3 g = some_gradient(size), strain = 0.5 * (g + g.transpose());
        const Mat3 hooke = law.lame * strain.trace() * Mat3::Identity() + 2 * law.shear * strain;
        CHECK((second_piola(g, law) - hooke).norm() < (5 * size + 1e-14) * hooke.norm());
      }
  }

  TEST_CASE("a solid turned inside out has no stress") {
    Mat3 g = Mat3::Zero();
    g(0, 0) = -1.5;
    CHECK_FALSE(second_piola(g, Hyperelastic{1, 1, true}).allFinite());
  }
}
