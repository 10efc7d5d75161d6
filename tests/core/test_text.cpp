#include <doctest/doctest.h>

#include <string>

#include "core/text.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("edit distance counts inserts, deletes, replacements and swaps") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("abc", "abc") == 0);
    CHECK(edit_distance("abc", "abcd") == 1);
    CHECK(edit_distance("abc", "ac") == 1);
    CHECK(edit_distance("abc", "axc") == 1);
    CHECK(edit_distance("abc", "acb") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("abc", "") == 3);
  }

  TEST_CASE("the nearest name is found within two edits") {
    const std::vector<std::string> names{"density", "viscosity", "sound_speed", "at"};
    CHECK(nearest_name("densty", names) == "density");
    CHECK(nearest_name("dnesity", names) == "density");
    CHECK(nearest_name("denssityy", names) == "density");
    CHECK(nearest_name("dxnsxtx", names).empty());
    CHECK(nearest_name("Sound-Speed", names) == "sound_speed");
    CHECK(nearest_name("visc", names) == "viscosity");
    CHECK(nearest_name("", names).empty());
  }

  TEST_CASE("short names allow one edit, and never a replacement of the whole name") {
    CHECK(nearest_name("aat", {"at"}) == "at");
    CHECK(nearest_name("a", {"at"}) == "at");
    CHECK(nearest_name("xy", {"at"}).empty());
    CHECK(nearest_name("x", {"t"}).empty());
    CHECK(nearest_name("abd", {"xyd"}).empty());
  }

  TEST_CASE("a prefix of two names suggests neither") {
    CHECK(nearest_name("domain_m", {"domain_minimum", "domain_maximum"}).empty());
  }

  TEST_CASE("suggestions list the names when none is near and they are few") {
    CHECK(suggestion("bx", {"box"}) == "did you mean 'box'?");
    CHECK(suggestion("quux", {"box", "sphere"}, "valid types") == "valid types: box and sphere");
    CHECK(suggestion("quux", std::vector<std::string>(40, "something")).empty());
    CHECK(in_words({"a", "b", "c"}, "or") == "a, b or c");
  }

  TEST_CASE("numbers are written with as few digits as read back exactly") {
    CHECK(exact(0.1) == "0.1");
    CHECK(exact(1000.0) == "1000");
    for (const double v : {1.0 / 3.0, 1e-300, -2.5e17, 0.1 + 0.2}) CHECK(std::stod(exact(v)) == v);
  }

  TEST_CASE("trimming drops blanks at both ends") {
    CHECK(trimmed("  a b \n") == "a b");
    CHECK(trimmed(" \t").empty());
  }
}
