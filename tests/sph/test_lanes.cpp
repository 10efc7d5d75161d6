#include "sph/append_below.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "core/aligned.h"
#include "sph/lane_vec.h"

using namespace sphgeo;

namespace {

template <class T>
Lanes<T> counting(T first, T step) {
  Lanes<T> a(0);
  for (int k = 0; k < Lanes<T>::width; ++k) a.raw[k] = first + step * static_cast<T>(k);
  return a;
}

template <class T>
void check_arithmetic(double tolerance) {
  using L = Lanes<T>;
  const L a = counting<T>(T(0.3), T(0.7)), b = counting<T>(T(4), T(-0.9));
  const T nan = std::numeric_limits<T>::quiet_NaN();
  for (int k = 0; k < L::width; ++k) {
    const T x = a[k], y = b[k];
    CHECK((a + b)[k] == x + y);
    CHECK((a - b)[k] == x - y);
    CHECK((a * b)[k] == x * y);
    CHECK((a / b)[k] == x / y);
    CHECK((-a)[k] == -x);
    CHECK((2 * a)[k] == 2 * x);
    CHECK(min(a, b)[k] == std::min(x, y));
    CHECK(max(a, b)[k] == std::max(x, y));
    CHECK(abs(b)[k] == std::fabs(y));
    CHECK(sqrt(a)[k] == std::sqrt(x));
    CHECK(select(a < b, a, b)[k] == (x < y ? x : y));
    CHECK(select(a >= b, a, b)[k] == (x >= y ? x : y));
    CHECK(rsqrt(a)[k] == doctest::Approx(1 / std::sqrt(double(x))).epsilon(tolerance));
    CHECK(reciprocal(b)[k] == doctest::Approx(1 / double(y)).epsilon(tolerance));
    CHECK(length(a)[k] == doctest::Approx(std::sqrt(double(x))).epsilon(2 * tolerance));
    // A NaN in the second place passes, as the guards of a run need.
    CHECK(std::isnan(max(L(0), L(nan))[k]));
    CHECK(std::isnan(min(L(1), L(nan))[k]));
    CHECK(length(L(0))[k] == 0);
    CHECK(std::isfinite(inverse_length(L(0))[k]));
  }
  CHECK(std::isnan(max(T(0), nan)));
  double total = 0;
  for (int k = 0; k < L::width; ++k) total += double(a[k]);
  CHECK(sum(a) == doctest::Approx(total).epsilon(1e-6));
}

template <class T>
void check_load() {
  AlignedVector<T> data(100 * record_size);
  std::iota(data.begin(), data.end(), T(0));
  std::vector<std::uint32_t> offset;
  for (unsigned k = 0; k < unsigned(Lanes<T>::width); ++k)
    offset.push_back(((k * 37 + 5) % 100) * record_size);
  Lanes<T> out[record_size];
  load_records(data.data(), offset.data(), out);
  std::set<std::uint32_t> seen;
  for (int k = 0; k < Lanes<T>::width; ++k) {
    const T first = out[0][k];
    for (int f = 0; f < record_size; ++f) CHECK(out[f][k] == first + T(f));
    seen.insert(static_cast<std::uint32_t>(first));
  }
  CHECK(seen == std::set<std::uint32_t>(offset.begin(), offset.end()));
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("arithmetic on lanes is arithmetic on each") {
    check_arithmetic<float>(2e-7);
    check_arithmetic<double>(4e-16);
  }

  TEST_CASE("the transposing load brings whole records") {
    check_load<float>();
    check_load<double>();
  }

  TEST_CASE("append_below keeps near lanes in order and leaves out the excluded one") {
    const FloatLanes distance = counting<float>(0.5f, 1.0f);
    IntLanes values{};
    for (int k = 0; k < FloatLanes::width; ++k) values[k] = 100 + k;
    std::uint32_t out[2 * FloatLanes::width] = {};
    CHECK(append_below(out, values, distance, FloatLanes(2.5f), -1) == out + 2);
    CHECK(out[0] == 100);
    CHECK(out[1] == 101);
    CHECK(append_below(out, values, distance, FloatLanes(1e9f), 101) ==
          out + FloatLanes::width - 1);
    CHECK(out[0] == 100);
    CHECK(out[1] == 102);
    CHECK(append_below(out, values, distance, FloatLanes(0.5f), -1) == out);
  }

  TEST_CASE("vectors of lanes") {
    const LaneVec<3, double> a{{1, 2, 3}}, b{{4, 5, 6}};
    CHECK(dot(a, b) == 32.0);
    CHECK(dot(a - b, 2.0 * a + b) == -3 * 6 - 3 * 9 - 3 * 12);
    const LaneVec<2, Lanes<float>> c{{Lanes<float>(1), Lanes<float>(2)}};
    CHECK(dot(c, c)[0] == 5.0f);
  }
}
