#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "sample_types.h"

using namespace sphgeo;
using namespace sphgeo::sample;

namespace {

namespace fs = std::filesystem;

/// A folder that is removed at the end of the test.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(fs::temp_directory_path() / ("sphgeo deck " + name)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::vector<Diagnostic> errors_of(const std::string& path,
                                  const std::vector<std::string>& sets = {}) {
  try {
    read_deck(path, sets);
    return {};
  } catch (const DeckError& e) {
    return e.diagnostics.items();
  }
}

constexpr const char* head = "dimension: 2\nresolution: 0.1\nend_time: 1\n";
constexpr const char* water = "materials:\n  - {name: water, type: sample_liquid}\n";

Diagnostic only(const std::vector<std::string>& sets) {
  const std::vector<Diagnostic> found = findings(good_deck(), sets);
  REQUIRE(found.size() == 1);
  return found.front();
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("included files are merged: lists appended, mappings merged") {
    const Folder folder("include");
    folder.write("main.yaml", std::string("include: [parts/a.yaml, b.yaml]\n") + head +
                                  "variables: {L: 2*a}\nnumerics: {limiter: L}\n"
                                  "materials: [{name: oil, type: sample_liquid}]\n");
    folder.write("parts/a.yaml", "include: [c.yaml]\nvariables: {a: 4}\nx-note: here\n");
    folder.write("parts/c.yaml", "materials: [{name: mud, type: sample_liquid}]\n");
    folder.write("b.yaml", std::string(water) + "numerics: {outside: stop}\nx-note: there\n");
    const Model m = read_deck(folder.file("main.yaml"));
    REQUIRE(m.materials.size() == 3);
    CHECK(m.materials[0]->name == "mud");
    CHECK(m.materials[1]->name == "water");
    CHECK(m.materials[2]->name == "oil");
    CHECK(m.numerics.limiter == 8.0);
    CHECK(m.numerics.outside == "stop");
    CHECK(m.place_of("materials[1].name").file == folder.file("b.yaml"));
  }

  TEST_CASE("findings in included files name those files") {
    const Folder folder("places");
    folder.write("main.yaml", std::string("include: [b.yaml]\n") + head);
    folder.write("b.yaml", "materials:\n  - {name: water, type: sample_liquid, densty: 3}\n");
    const auto found = errors_of(folder.file("main.yaml"));
    REQUIRE(found.size() == 1);
    CHECK(found[0].place.file == folder.file("b.yaml"));
    CHECK(found[0].place.line == 2);
  }

  TEST_CASE("cycles, doubles, conflicts and missing files are refused") {
    const Folder folder("wrong");
    folder.write("self.yaml", std::string("include: [self.yaml]\n") + head + water);
    folder.write("loop.yaml", std::string("include: [loop2.yaml]\n") + head + water);
    folder.write("loop2.yaml", "include: [loop.yaml]\n");
    folder.write("twice.yaml", std::string("include: [w.yaml, ./w.yaml]\n") + head);
    folder.write("w.yaml", water);
    folder.write("conflict.yaml", std::string("include: [e.yaml]\n") + head + water);
    folder.write("e.yaml", "\nend_time: 5\n");
    folder.write("gone.yaml", std::string("include: [nowhere.yaml]\n") + head + water);
    folder.write("scalar.yaml", std::string("include: w.yaml\n") + head);
    folder.write("odd.yaml", std::string("include: [[w.yaml]]\n") + head);
    const auto id_of = [&](const char* name) {
      const auto found = errors_of(folder.file(name));
      return found.size() == 1 ? found[0].id : "findings: " + std::to_string(found.size());
    };
    CHECK(id_of("self.yaml") == "E007");
    CHECK(id_of("loop.yaml") == "E007");
    CHECK(id_of("twice.yaml") == "E007");
    CHECK(id_of("conflict.yaml") == "E007");
    CHECK(id_of("gone.yaml") == "E001");
    CHECK(id_of("scalar.yaml") == "E010");
    CHECK(id_of("odd.yaml") == "E010");
    CHECK(id_of("not there.yaml") == "E001");
  }

  TEST_CASE("files named in a deck are looked up beside the file that names them") {
    const Folder folder("files");
    folder.write("main.yaml", std::string("include: [parts/a.yaml]\n") + head + water);
    folder.write("parts/a.yaml", "boundaries: [{name: f, type: sample_fence, table: t.csv}]\n");
    folder.write("parts/t.csv", "t\n");
    const Model m = read_deck(folder.file("main.yaml"));
    const auto* fence = dynamic_cast<const Fence*>(m.boundaries[0].get());
    REQUIRE(fence != nullptr);
    CHECK(fence->table->path == folder.file("parts/t.csv"));
    // The resolved deck may be read from anywhere.
    CHECK(resolved_yaml(read_deck_text(resolved_yaml(m))) == resolved_yaml(m));

    const auto found = errors_of(folder.file("main.yaml"), {"boundaries.f.table=no.csv"});
    REQUIRE(found.size() == 1);
    CHECK(found[0].id == "E018");
    CHECK(found[0].place.file == "--set #1");
  }

  TEST_CASE("overrides reach variables, sections, elements by number and by name") {
    const Model m = read_deck_text(good_deck(),
                                   {"H=0.3", "resolution=2 cm", "bodies[0].shape.max[0]=0.7",
                                    "bodies.column.shape.rounding=0.05", "numerics.outside=stop",
                                    "bodies.column.velocity=[1, 2, x]", "output.run_every = 0.5 "});
    CHECK(*m.variables.find("H") == 0.3);
    CHECK(m.resolution == 0.02);
    const auto* block = dynamic_cast<const Block*>(m.bodies[0].shape.get());
    REQUIRE(block != nullptr);
    CHECK(block->max.x() == 0.7);
    CHECK(block->max.z() == 0.3);
    CHECK(*block->rounding == 0.05);
    CHECK(m.numerics.outside == "stop");
    CHECK(*m.output.run_every == 0.5);
    CHECK(m.place_of("resolution").file == "--set #2");
  }

  TEST_CASE("wrong overrides cite their number and suggest names") {
    CHECK(only({"H=0.3", "HH=1"}).place.file == "--set #2");
    CHECK(only({"HH=1"}).help == "did you mean 'H'?");
    CHECK(only({"end_tme=1"}).help == "did you mean 'end_time'?");
    CHECK(only({"variables.Q=1"}).id == "E008");
    CHECK(only({"bodies.colum.level=1"}).help == "did you mean 'column'?");
    CHECK(only({"bodies[3].level=1"}).id == "E008");
    CHECK(only({"title[0]=1"}).id == "E008");
    CHECK(only({"title.a=1"}).id == "E008");
    CHECK(only({"include=[a.yaml]"}).id == "E008");
    for (const char* bad :
         {"nothing", "=3", "a..b=1", "a[x]=1", "a[1=1", "[0]=1", "a b=1", "a.=1"}) {
      CAPTURE(bad);
      CHECK(only({bad}).id == "E008");
    }
    const Diagnostic unknown = only({"numerics.limitr=3"});
    CHECK(unknown.id == "E012");
    CHECK(unknown.place.file == "--set #1");
    CHECK(unknown.place.column == 10);
    CHECK(only({"numericz.limiter=3"}).id == "E012");
    CHECK(only({"end_time=3 m"}).place.column == 10);
    CHECK(only({"end_time="}).id == "E010");
    CHECK(only({"end_time={a: [}"}).id == "E002");
  }
}
