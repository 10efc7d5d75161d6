#pragma once
// Small vectors of pair functions: Dim components, each a double or lanes.

#include "sph/lanes.h"

namespace sphgeo {

/// A vector whose components are of number type T (double or Lanes). Starts at zero.
template <int Dim, class T>
struct LaneVec {
  T c[Dim] = {};

  T& operator[](int k) { return c[k]; }
  const T& operator[](int k) const { return c[k]; }

  friend LaneVec operator+(const LaneVec& a, const LaneVec& b) {
    return each([&](int k) { return a[k] + b[k]; });
  }
  friend LaneVec operator-(const LaneVec& a, const LaneVec& b) {
    return each([&](int k) { return a[k] - b[k]; });
  }
  friend LaneVec operator*(const T& s, const LaneVec& a) {
    return each([&](int k) { return s * a[k]; });
  }
  friend LaneVec operator*(const LaneVec& a, const T& s) { return s * a; }
  LaneVec& operator+=(const LaneVec& b) { return *this = *this + b; }
  LaneVec& operator-=(const LaneVec& b) { return *this = *this - b; }

  friend T dot(const LaneVec& a, const LaneVec& b) {
    T s = a[0] * b[0];
    for (int k = 1; k < Dim; ++k) s += a[k] * b[k];
    return s;
  }

 private:
  template <class F>
  static LaneVec each(F f) {
    LaneVec v;
    for (int k = 0; k < Dim; ++k) v[k] = f(k);
    return v;
  }
};

}  // namespace sphgeo
