#include <doctest/doctest.h>

#include "deck/yaml_reader.h"
#include "deck/yaml_writer.h"

using namespace sphgeo;

namespace {

Node tree(const std::string& text) {
  Diagnostics found;
  const std::optional<Node> root = read_yaml(text, "a.yaml", found);
  REQUIRE(root.has_value());
  CHECK(found.items().empty());
  return *root;
}

/// "E003@2:1" for a single finding.
std::string finding(const std::string& text, const YamlLimits& limits = {}) {
  Diagnostics found;
  read_yaml(text, "a.yaml", found, limits);
  if (found.items().size() != 1) return "findings: " + std::to_string(found.items().size());
  const Diagnostic& d = found.items().front();
  return d.id + "@" + std::to_string(d.place.line) + ":" + std::to_string(d.place.column);
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("the tree keeps order, quotes and the places of keys and values") {
    const Node root = tree("b: 1\na:\n  - x\n  - {c: 'y z'}\n");
    REQUIRE(root.entries.size() == 2);
    CHECK(root.entries[0].key == "b");
    CHECK(root.entries[1].place.line == 2);
    const Node& list = root.entries[1].value;
    REQUIRE(list.items.size() == 2);
    CHECK(list.items[0].place.line == 3);
    CHECK(list.items[0].place.column == 5);
    const Entry& c = list.items[1].entries[0];
    CHECK(c.value.text == "y z");
    CHECK(c.value.quoted);
    CHECK(c.place.column == 6);
    CHECK(c.value.place.column == 9);
  }

  TEST_CASE("an alias stands where it is written, an empty value where its key is") {
    const Node root = tree("a: &p [1, 2]\nb: *p\nc:\nd: 1\n");
    CHECK(root.find("b")->value.items.size() == 2);
    CHECK(root.find("b")->value.place.line == 2);
    CHECK(root.find("c")->value.kind == Node::Kind::null);
    CHECK(root.find("c")->value.place.line == 3);
  }

  TEST_CASE("what YAML libraries pass silently is refused with its place") {
    CHECK(finding("a: 1\nb: 2\na: 3\n") == "E003@3:1");
    CHECK(finding("a: {b: 1, b: 2}\n") == "E003@1:11");
    CHECK(finding("p: &p {a: 1}\nq:\n  <<: *p\n") == "E004@3:3");
    CHECK(finding("a: !special 1\n").substr(0, 6) == "E004@1");
    CHECK(finding("? [1, 2]\n: 3\n").substr(0, 6) == "E004@1");
    CHECK(finding("a: &p [*p]\n").substr(0, 6) == "E004@1");
    CHECK(finding("a: 1\n---\nb: 2\n").substr(0, 4) == "E005");
    CHECK(finding("a: [1, 2\n").substr(0, 4) == "E002");
    CHECK(finding("a: b: c\n").substr(0, 6) == "E002@1");
    CHECK(finding(std::string("a: 1\nb: \x04 2\n")) == "E002@2:4");
    CHECK(finding(std::string("a: 1\0b: 2", 9)) == "E002@1:5");
    CHECK(finding("a: *nowhere\n").substr(0, 6) == "E002@1");
  }

  TEST_CASE("large, deep and multiplying decks are refused") {
    YamlLimits limits;
    limits.bytes = 10;
    CHECK(finding("title: a long deck", limits).substr(0, 4) == "E006");
    CHECK(finding("a: " + nested(70)).substr(0, 4) == "E006");
    CHECK(finding("a: " + nested(100000)).substr(0, 1) == "E");
    std::string bomb = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (char c = 'b'; c < 'j'; ++c) {
      const char before = static_cast<char>(c - 1);
      bomb += std::string(1, c) + ": &" + c + " [";
      for (int k = 0; k < 10; ++k) bomb += std::string(k == 0 ? "*" : ", *") + before;
      bomb += "]\n";
    }
    CHECK(finding(bomb).substr(0, 4) == "E006");
  }

  TEST_CASE("what aliases and anchors cost is counted") {
    YamlLimits limits;
    limits.bytes = 3000;
    const std::string text(500, 't');
    CHECK(finding("a: &a " + text + "\nb: [*a, *a]\n", limits) == "findings: 0");
    CHECK(finding("a: &a " + text + "\nb: [*a, *a, *a, *a, *a]\n", limits) == "E006@2:17");
    limits = {};
    limits.nodes = 100;
    std::string list;
    for (int k = 0; k < 30; ++k) list += "1,";
    CHECK(finding("a: &a [" + list + "]\n", limits) == "findings: 0");
    CHECK(finding("a: &a [&b [&c [" + list + "]]]\n", limits).substr(0, 4) == "E006");
    limits = {};
    limits.depth = 5;
    CHECK(finding("a: &a [[1]]\nb: [[*a]]\n", limits) == "findings: 0");
    CHECK(finding("a: &a [[1]]\nb: [[[*a]]]\n", limits) == "E006@2:7");
  }

  TEST_CASE("long values, long keys and many keys are refused at their place") {
    YamlLimits limits;
    limits.text = 20;
    limits.key = 5;
    limits.keys = 3;
    CHECK(finding("a: 12345678901234567890\n", limits) == "findings: 0");
    CHECK(finding("a: b\nc: 123456789012345678901\n", limits) == "E006@2:4");
    CHECK(finding("abcdef: 1\n", limits) == "E006@1:1");
    CHECK(finding("a: 1\nb: 1\nc: 1\n", limits) == "findings: 0");
    CHECK(finding("a: 1\nb: 1\nc: 1\nd: 1\n", limits) == "E006@4:1");
  }

  TEST_CASE("what costs the library much memory is refused before it is read") {
    YamlLimits limits;
    limits.line = 20;
    CHECK(finding("a: 1\nb: 12345678901234567\nc: 3", limits) == "findings: 0");
    CHECK(finding("a: 1\nb: 123456789012345678\nc: 3", limits) == "E006@2:1");
    CHECK(finding("a: 1 # a comment counts", limits) == "E006@1:1");
    limits = {};
    limits.punctuation = 7;
    CHECK(finding("a: [[1], 2]\nb: [3,\n4\n", limits) == "E002@4:1");
    CHECK(finding("a: [[1], 2]\nb: [3,\n4]\n", limits) == "E006@3:2");
    CHECK(finding("a: [[1], 2]\nb: {\n}\n", limits) == "findings: 0");
    CHECK(finding("a: [[1], 2]\nb: {}\nc: '},'\n", limits) == "E006@3:5");
    // The defaults.
    const std::string longest(YamlLimits{}.line - 3, '#');
    CHECK(finding("a: #" + longest) == "E006@1:1");
    CHECK(finding("\na: #" + longest.substr(1)) == "findings: 0");
    std::string many;
    for (int k = 0; k < 400000; ++k) many += "[\n";
    CHECK(finding(many).substr(0, 4) == "E006");
    CHECK(finding(many + many) == "E006@600001:1");
  }

  TEST_CASE("control characters that quoted texts spell out are refused at their place") {
    for (const char* escape : {"\\e", "\\0", "\\a", "\\x1b", "\\x7F", "\\u0007"}) {
      CAPTURE(escape);
      CHECK(finding(std::string("a: 1\nb: \"x") + escape + "[31m\"\n") == "E002@2:4");
      CHECK(finding(std::string("a: 1\n\"x") + escape + "\": 2\n") == "E002@2:1");
    }
    for (const char* escape : {"\\N", "\\_"}) {  // no UTF-8, as the library reads them
      CAPTURE(escape);
      CHECK(finding(std::string("a: 1\nb: \"x") + escape + "\"\n") == "E002@2:4");
    }
    CHECK(tree("a: \"\\u00a0\\L\"").find("a")->value.text == "\xC2\xA0\xE2\x80\xA8");
    CHECK(tree("a: \"x\\ty\\n\\r\"").find("a")->value.text == "x\ty\n\r");
    CHECK(tree("a: 'x\\e'").find("a")->value.text == "x\\e");  // no escape in single quotes
  }

  TEST_CASE("other encodings than UTF-8 are named") {
    CHECK(finding("a: 1\nb: 'gr\xF6\xDF'\n") == "E002@2:7");
    CHECK(finding(std::string("\xFF\xFE"
                              "a\0:\0",
                              6)) == "E002@1:1");
    CHECK(finding(std::string("\xFE\xFF\0a\0:", 6)) == "E002@1:1");
    CHECK(finding("a: 'gr\xC3\xB6\xC3\x9F'\n") == "findings: 0");
  }

  TEST_CASE("an empty text is nothing, comments and a leading --- are fine") {
    CHECK(tree("").kind == Node::Kind::null);
    CHECK(tree("# only a comment\n").kind == Node::Kind::null);
    CHECK(tree("%YAML 1.2\n---\na: 1\n...\n").entries.size() == 1);
    CHECK(tree("\xEF\xBB\xBF"
               "a: 1\r\n")
              .find("a")
              ->value.text == "1");
  }

  TEST_CASE("what the writer writes, the reader reads back") {
    Node root = Node::map();
    for (const char* text :
         {"plain", "two words", "", "a: b", "#x", "- x", "it's \"q\" \\ \n\t", "-1", "*x", "{",
          "true", "x-", "0.5*t^2", "(1)", "/a/b c.csv", "%", "\xC3\xA4"}) {
      root.add("k" + std::to_string(root.entries.size()), Node::scalar(text));
    }
    root.add("empty_list", Node::list());
    root.add("empty_map", Node::map());
    root.add("lists", Node::list({Node::list({Node::scalar("1"), Node::scalar("2")})}));
    Node inner = Node::map();
    inner.add("a", Node::scalar("1"));
    inner.add("b", Node::list({inner, inner}));
    root.add("maps", Node::list({inner, Node::scalar("x"), inner}));
    const std::string text = write_yaml(root);
    CAPTURE(text);
    const Node back = tree(text);
    REQUIRE(back.entries.size() == root.entries.size());
    for (std::size_t k = 0; k < root.entries.size(); ++k) {
      CHECK(back.entries[k].value.text == root.entries[k].value.text);
    }
    CHECK(write_yaml(back).size() == text.size());
    CHECK(back.find("maps")->value.items[2].find("b")->value.items[1].find("a")->value.text == "1");
  }

  TEST_CASE("files that cannot be read say why") {
    Diagnostics found;
    CHECK_FALSE(read_text_file("/no/such/file", {}, found).has_value());
    CHECK_FALSE(read_text_file("/", {}, found).has_value());
    CHECK_FALSE(read_text_file("/dev/null", {}, found, true).has_value());
    CHECK_FALSE(read_text_file("/dev/zero", {}, found, false, 1000).has_value());
    CHECK(read_text_file("/dev/null", {}, found) == "");
    REQUIRE(found.items().size() == 4);
    CHECK(found.items()[2].message.find("not a regular file") != std::string::npos);
    CHECK(found.items()[3].id == "E006");
    CHECK(found.items()[0].id == "E001");
    CHECK(found.items()[0].message.find("No such file") != std::string::npos);
    CHECK(found.items()[1].message.find("folder") != std::string::npos);
  }
}
