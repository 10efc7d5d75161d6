#include <doctest/doctest.h>

#include <algorithm>

#include "core/diagnostic.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("a finding shows place, id, line, caret and help") {
    Diagnostics found;
    found.keep_source("deck.yaml", "materials:\n  - porositty: 0.4\n");
    found.error("E012", {"deck.yaml", 2, 5}, "materials[0]",
                "unknown key 'porositty' in materials[0]", "did you mean 'porosity'?");
    CHECK(found.render() ==
          "deck.yaml:2:5: error[E012]: unknown key 'porositty' in materials[0]\n"
          "    2 |   - porositty: 0.4\n"
          "      |     ^~~~~~~~~ did you mean 'porosity'?\n");
  }

  TEST_CASE("the key path is put in front when the message lacks it") {
    Diagnostics found;
    found.error("E014", {"deck.yaml", 0, 0}, "a.b", "is out of range", "must be positive");
    const std::string text = found.render();
    CHECK(text.find("a.b: is out of range") != std::string::npos);
    CHECK(text.find("help: must be positive") != std::string::npos);
  }

  TEST_CASE("findings come in the order of files and lines, overrides without a line") {
    Diagnostics found;
    found.keep_source("b.yaml", "x: 1\ny: 2\n");
    found.keep_source("a.yaml", "x: 1\n");
    found.keep_source("--set #1", "x=1");
    found.error("E1", {"--set #1", 1, 1}, "", "third");
    found.error("E1", {"a.yaml", 1, 1}, "", "second");
    found.error("E1", {"b.yaml", 2, 1}, "", "first");
    const std::string text = found.render();
    CHECK(text.find("first") < text.find("second"));
    CHECK(text.find("second") < text.find("third"));
    CHECK(text.find("--set #1: error") != std::string::npos);
  }

  TEST_CASE("no part of a finding can drive a terminal, and the caret stands where it belongs") {
    Diagnostics found;
    found.keep_source("d\x1B[2J",
                      "\ta\xC2\x9B"
                      "\x1B\xFF: v\x1B"
                      "alue\xE2\x80\xAE\n");
    found.error("E012", {"d\x1B[2J", 1, 9}, "a\x1B[31m", "unknown key 'a\nb\x07'",
                "did you mean '\x1B]0;x\xC3'?");
    CHECK(found.render() ==
          "d?[2J:1:9: error[E012]: a?[31m: unknown key 'a?b?'\n"
          "    1 |  a???: v?alue?\n"
          "      |        ^~~~~~~ did you mean '?]0;x?'?\n");
    Diagnostics alone;
    alone.error("E001", {}, "", "cannot read '\x1B[31m\xC3.yaml'", "help\x7F");
    CHECK(alone.render() == "error[E001]: cannot read '?[31m?.yaml'\n      = help: help?\n");
    CHECK(alone.render(true).find("\x1B[1m") == 0);  // colors of our own stay
  }

  TEST_CASE("warnings are no errors") {
    Diagnostics found;
    found.warning("W030", {}, "", "odd");
    CHECK_FALSE(found.has_errors());
    CHECK(found.render() == "warning[W030]: odd\n");
    found.error("E030", {}, "", "wrong");
    CHECK(found.has_errors());
  }

  TEST_CASE("after twenty errors only their number is given") {
    Diagnostics found;
    for (int k = 0; k < 25; ++k) found.error("E012", {"d", k + 1, 1}, "", "unknown");
    const std::string text = found.render();
    CHECK(text.find("... and 5 more errors") != std::string::npos);
    CHECK(std::count(text.begin(), text.end(), '\n') == 21);
  }
}
