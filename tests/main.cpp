// The one test binary. Each room is a test suite of its own name: `sphgeo_tests --test-suite=deck`.

#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
