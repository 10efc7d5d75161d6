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
    CHECK(nearest_name("d3", {"d0", "d33", "x3"}) == "d33");
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
    // Names that begin like it, or share a word with it.
    const std::vector<std::string> effects{"interface_state", "interface_force", "drag"};
    CHECK(suggestion("interfac", effects) ==
          "did you mean 'interface_state' or 'interface_force'?");
    CHECK(suggestion("skin_state", effects) == "did you mean 'interface_state'?");
    CHECK(in_words({"a", "b", "c"}, "or") == "a, b or c");
  }

  TEST_CASE("numbers are written with as few digits as read back exactly") {
    CHECK(exact(0.1) == "0.1");
    CHECK(exact(1000.0) == "1000");
    for (const double v : {1.0 / 3.0, 1e-300, -2.5e17, 0.1 + 0.2}) CHECK(std::stod(exact(v)) == v);
  }

  TEST_CASE("texts are cut between characters") {
    CHECK(shortened("abc", 3) == "abc");
    CHECK(shortened("abcd", 3) == "abc...");
    CHECK(shortened("a\xC3\xA4"
                    "b",
                    2) == "a...");
    CHECK(shortened("\xE6\xB0\xB4\xE6\xB0\xB4", 4) == "\xE6\xB0\xB4...");
    CHECK(shortened("\x80\x80\x80", 2) == "...");
  }

  TEST_CASE("bytes that are no UTF-8 are found") {
    constexpr auto none = std::string_view::npos;
    CHECK(invalid_utf8(
              "plain \xC3\xA4 \xE6\xB0\xB4 \xF0\x9F\x8C\x8A \xEF\xBF\xBF \xF4\x8F\xBF\xBF") ==
          none);
    CHECK(invalid_utf8("") == none);
    CHECK(invalid_utf8("ab\xF6"
                       "d") == 2);
    CHECK(invalid_utf8("a\x80") == 1);
    CHECK(invalid_utf8("a\xC3") == 1);     // cut short
    CHECK(invalid_utf8("\xC0\xAF") == 0);  // longer than needed
    CHECK(invalid_utf8("\xE0\x9F\xBF") == 0);
    CHECK(invalid_utf8("\xF0\x8F\xBF\xBF") == 0);
    CHECK(invalid_utf8("\xED\xA0\x80") == 0);      // a surrogate
    CHECK(invalid_utf8("\xF4\x90\x80\x80") == 0);  // beyond U+10FFFF
    CHECK(invalid_utf8("\xFF\xFE") == 0);
  }

  TEST_CASE("nothing that a terminal obeys is printable") {
    CHECK(printable("plain, \xC3\xA4 \xE6\xB0\xB4 \xF0\x9F\x8C\x8A") ==
          "plain, \xC3\xA4 \xE6\xB0\xB4 \xF0\x9F\x8C\x8A");
    CHECK(printable(std::string("a\x1B[31m\x07\x7F\r\0z", 11)) == "a?[31m????z");
    CHECK(printable("a\tb\nc") == "a b?c");
    CHECK(printable("a\tb\nc\x1B", "\n") == "a b\nc?");
    CHECK(printable("\xC2\x9B"
                    "31m \xC2\x85 \xC2\xA0") == "?31m ? \xC2\xA0");  // C1; a hard blank is none
    CHECK(printable("\xE2\x80\xAEx\xE2\x81\xA6y\xE2\x80\xA8 \xE2\x80\x93") ==
          "?x?y? \xE2\x80\x93");  // directions, not a dash
    CHECK(printable("\x9B"
                    "31m \xFF\xFE \xC3") == "?31m ?? ?");  // no UTF-8
    CHECK(printable("") == "");
  }

  TEST_CASE("trimming drops blanks at both ends") {
    CHECK(trimmed("  a b \n") == "a b");
    CHECK(trimmed(" \t").empty());
  }
}
