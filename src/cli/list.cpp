// `sphgeo list`, `sphgeo show` and `sphgeo reference`: the catalog as text and as a page.

#include <fmt/format.h>

#include <iostream>

#include "cli/catalog.h"
#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"

namespace sphgeo {
namespace {

std::string lead(const KeyFacts& k) {
  return k.required ? "required" : k.otherwise.empty() ? "optional" : "default " + k.otherwise;
}

void print_entry(const CatalogGroup& group, const CatalogEntry& entry) {
  std::cout << fmt::format("{} ({}): {}\n", entry.name, group.kind, entry.sentence);
  for (const KeyFacts& k : entry.keys)
    std::cout << fmt::format("  {}\n      {}{}\n      {}; {}{}\n", k.name, k.sentence,
                             k.equation.empty() ? "" : " (" + k.equation + ")", k.accepts, lead(k),
                             k.changeable ? "; may change on resume" : "");
  for (const auto& [what, value] : entry.facts)
    std::cout << fmt::format("  {:<10} {}\n", what, value);
  if (!entry.columns.empty()) std::cout << fmt::format("columns, in 3D:\n");
  for (const Column& c : entry.columns)
    std::cout << fmt::format("  {}\n      {}\n", c.heading(), c.sentence);
}

/// Text in a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

void print_keys(const CatalogEntry& entry) {
  std::cout << fmt::format("| key | accepts | default | what it means |\n|---|---|---|---|\n");
  for (const KeyFacts& k : entry.keys)
    std::cout << fmt::format("| `{}` | {} | {} | {}{} |\n", k.name, cell(k.accepts),
                             k.required            ? "required"
                             : k.otherwise.empty() ? ""
                                                   : "`" + cell(k.otherwise) + "`",
                             cell(k.sentence), k.equation.empty() ? "" : " (" + k.equation + ")");
  std::cout << fmt::format("\n");
  if (entry.columns.empty()) return;
  std::cout << fmt::format("| column | unit | what it is |\n|---|---|---|\n");
  for (const Column& c : entry.columns)
    std::cout << fmt::format("| `{}` | {} | {} |\n", c.name, c.unit, cell(c.sentence));
  std::cout << fmt::format("\n");
}

/// A group whose entries have no keys: one table of all.
void print_facts(const CatalogGroup& group) {
  std::string head = "| name |", rule = "|---|";
  for (const auto& [what, value] : group.entries.front().facts) {
    head += " " + what + " |";
    rule += "---|";
  }
  std::cout << fmt::format("{} what it is |\n{}---|\n", head, rule);
  for (const CatalogEntry& e : group.entries) {
    std::cout << fmt::format("| `{}` |", e.name);
    for (const auto& [what, value] : e.facts) std::cout << fmt::format(" {} |", cell(value));
    std::cout << fmt::format(" {} |\n", cell(e.sentence));
  }
  std::cout << fmt::format("\n");
}

}  // namespace

int list_command() {
  const char* between = "";
  for (const CatalogGroup& group : catalog()) {
    std::cout << fmt::format("{}{}:\n", between, group.heading);
    for (const CatalogEntry& entry : group.entries)
      std::cout << fmt::format("  {:<24} {}\n", entry.name, entry.sentence);
    between = "\n";
  }
  return 0;
}

int show_command(const std::string& name) {
  std::vector<std::string> names;
  const char* between = "";
  for (const CatalogGroup& group : catalog())
    for (const CatalogEntry& entry : group.entries) {
      names.push_back(entry.name);
      if (entry.name != name) continue;
      std::cout << fmt::format("{}", between);
      print_entry(group, entry);
      between = "\n";
    }
  if (*between != '\0') return 0;
  const std::string near = suggestion(name, names);
  throw Error(ExitCode::usage, fmt::format("there is no type '{}'; {}", name,
                                           near.empty() ? "'sphgeo list' prints them all" : near));
}

int reference_command() {
  std::cout << fmt::format(
      "# Reference\n\n"
      "All keys of a deck, all types, effects and fields. Printed by `sphgeo reference` from the "
      "declarations that the\n"
      "reader of decks uses; `sphgeo show NAME` prints one of them.\n\n"
      "Numbers are in SI units; a number with a unit, such as `18 kPa` or `30 deg`, is accepted "
      "where the dimension\n"
      "fits, and so are formulas of the deck's `variables`. `auto` is explained in the key's "
      "description.\n");
  for (const CatalogGroup& group : catalog()) {
    std::cout << fmt::format("\n## {}{}\n\n{}\n\n", static_cast<char>(group.heading[0] - 'a' + 'A'),
                             group.heading.substr(1), group.sentence);
    if (group.entries.empty()) continue;
    if (group.entries.front().keys.empty()) {
      print_facts(group);
      continue;
    }
    for (const CatalogEntry& entry : group.entries) {
      std::cout << fmt::format("### {}\n\n{}\n\n", entry.name, entry.sentence);
      print_keys(entry);
    }
  }
  return 0;
}

}  // namespace sphgeo
