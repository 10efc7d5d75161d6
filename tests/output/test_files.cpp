#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "output/pvd.h"
#include "output/run_folder.h"
#include "temporary_folder.h"

using namespace sphgeo;
namespace fs = std::filesystem;

namespace {

template <class Action>
std::string io_failure(Action action) {
  try {
    action();
  } catch (const IoError& e) {
    CHECK(e.code() == ExitCode::io);
    return e.what();
  }
  return {};
}

/// Runs the action in a child that may write files of at most `bytes`; the child's exit code.
template <class Action>
int with_file_limit(rlim_t bytes, Action action) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);  // write(2) then fails with EFBIG
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(action());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("an atomic file appears whole, and replaces the old one") {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "a.txt", "one");
    write_file_atomically(folder / "a.txt", "two");
    CHECK(read_file(folder / "a.txt") == "two");
    {
      AtomicFile file(folder / "a.txt");
      file.write("never committed");
    }
    CHECK(read_file(folder / "a.txt") == "two");
    CHECK(folder.entries() == 1);
    const std::string large(3 << 20, 'x');
    write_file_atomically(folder / "a.txt", large);
    CHECK(read_file(folder / "a.txt") == large);
    CHECK_THROWS_AS(read_file(folder / "a.txt", 1000), IoError);
  }

  TEST_CASE("large arrays go to the disk as they are, at every place in memory and in the file") {
    const test::TemporaryFolder folder;
    constexpr std::size_t page = 4096;
    const std::size_t bytes = (std::size_t{6} << 20) + 123;
    std::vector<std::uint64_t> random(bytes / 8 + 2 * page / 8);
    for (std::size_t k = 0; k < random.size(); ++k) random[k] = random_bits(5, k);
    const auto* first = reinterpret_cast<const char*>(random.data());
    const char* whole_page = first + (page - reinterpret_cast<std::uintptr_t>(first) % page) % page;
    for (const char* from : {whole_page, whole_page + 8})
      for (const std::string& before :
           {std::string(), std::string(page, 'b'), std::string("line\n")}) {
        AtomicFile file(folder / "a");
        file.write(before);
        file.write(from, bytes);
        file.write("end\n");
        file.commit();
        CHECK(read_file(folder / "a") == before + std::string(from, bytes) + "end\n");
      }
    // A disk that is full within whole pages and between them.
    for (const rlim_t limit : {rlim_t{5} << 20, (rlim_t{5} << 20) + 77})
      CHECK(with_file_limit(limit, [&] {
              const std::string what = io_failure([&] {
                AtomicFile file(folder / "b", bytes);
                file.write(whole_page, bytes);
                file.commit();
              });
              return what.find("cannot write (6291579 bytes needed)") != std::string::npos &&
                             !fs::exists(folder / "b")
                         ? 7
                         : 1;
            }) == 7);
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("failures name the path, the bytes and the system's words") {
    CHECK(io_failure([] { write_file_atomically("/nowhere/a", "x"); }) ==
          "/nowhere/a: cannot create the file: No such file or directory");
    CHECK(io_failure([] { write_file_atomically("/dev/full", "xyz"); }) ==
          "/dev/full: cannot write (3 bytes needed): No space left on device");
    CHECK(fs::is_character_file("/dev/full"));  // written to, not replaced
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "taken");
    CHECK(io_failure([&] { write_file_atomically(folder / "taken", "x"); }) ==
          folder / "taken" + ": cannot rename the finished file to this name: Is a directory");
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("a disk that fills up half-way leaves the old file and no half-written one") {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "a.txt", "old");
    CHECK(with_file_limit(2 << 20, [&] {
            const std::string large(5 << 20, 'x');
            const std::string said =
                io_failure([&] { write_file_atomically(folder / "a.txt", large); });
            return said.find("(5242880 bytes needed): File too large") != std::string::npos ? 7 : 8;
          }) == 7);
    CHECK(read_file(folder / "a.txt") == "old");
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("a collection is valid after every frame and keeps full precision") {
    const test::TemporaryFolder folder;
    PvdFile pvd(folder / "water.pvd");
    CHECK(folder.entries() == 0);
    pvd.add(0, "water_000000.vtu");
    pvd.add(0.1 + 0.2, "a&\"b\".vtu");
    CHECK(read_file(folder / "water.pvd") ==
          "<?xml version=\"1.0\"?>\n<!-- written by sphgeo -->\n"
          "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
          "<Collection>\n"
          "    <DataSet timestep=\"0\" part=\"0\" file=\"water_000000.vtu\"/>\n"
          "    <DataSet timestep=\"0.30000000000000004\" part=\"0\" "
          "file=\"a&amp;&quot;b&quot;.vtu\"/>\n"
          "  </Collection>\n</VTKFile>\n");
    pvd.add(1, "late.vtu");

    const PvdFile again = PvdFile::resume(folder / "water.pvd", 0.5);
    REQUIRE(again.frames().size() == 2);
    CHECK(again.frames()[1].time == 0.1 + 0.2);
    CHECK(again.frames()[1].file == "a&\"b\".vtu");
    CHECK(read_file(folder / "water.pvd").find("late.vtu") == std::string::npos);
    pvd.add(1,
            "anew.vtu");  // what is written again from an earlier time on replaces the old frames
    CHECK(pvd.frames().size() == 3);
    CHECK(pvd.frames().back().file == "anew.vtu");
    pvd.add(2, "anew.vtu");  // something at rest is written once and named at every time
    CHECK(pvd.frames().size() == 4);
    CHECK(pvd.frames()[2].file == pvd.frames()[3].file);
  }

  TEST_CASE("a damaged collection is refused") {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "a.pvd", "<DataSet timestep=\"x\" file=\"a\"/>");
    CHECK_THROWS_AS(PvdFile::resume(folder / "a.pvd", 1), IoError);
    write_file_atomically(folder / "a.pvd", "<DataSet timestep=\"1\"/>");
    CHECK_THROWS_AS(PvdFile::resume(folder / "a.pvd", 1), IoError);
    write_file_atomically(folder / "a.pvd", "<DataSet timestep=\"nan\" file=\"a\"/>");
    CHECK_THROWS_AS(PvdFile::resume(folder / "a.pvd", 1), IoError);
    write_file_atomically(folder / "a.pvd", "<DataSet timestep=\"1\" file=\"a\"\n/>");
    CHECK_THROWS_AS(PvdFile::resume(folder / "a.pvd", 1), IoError);
    CHECK_THROWS_AS(PvdFile::resume(folder / "none.pvd", 1), IoError);
  }

  TEST_CASE("a run folder is created, and refused when it holds results") {
    const test::TemporaryFolder folder;
    const RunFolder run(folder / "deep/run/");
    CHECK(run.path() == folder / "deep/run");
    CHECK(fs::is_directory(run.path() + "/probes"));
    CHECK(fs::is_directory(run.path() + "/frames"));
    CHECK(run.frame("water", 12) == run.path() + "/frames/water_000012.vtu");
    CHECK(RunFolder::frame_name("water", 12) == "water_000012.vtu");
    CHECK_FALSE(holds_results(run.path()));
    RunFolder(run.path());  // empty folders are no results
    write_file_atomically(run.summary(), "{}");
    CHECK(holds_results(run.path()));
    try {
      RunFolder again(run.path());
      FAIL("not refused");
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::usage);
      CHECK(std::string(e.what()).find("summary.json") != std::string::npos);
      CHECK(std::string(e.what()).find("--overwrite") != std::string::npos);
    }
    RunFolder(run.path(), ExistingResults::resume);
    CHECK(fs::exists(run.summary()));
  }

  TEST_CASE("a folder is held by one run, and goes away when it was made for nothing") {
    const test::TemporaryFolder folder;
    const std::string path = folder / "run";
    {
      const FolderLock held(path);
      CHECK(fs::is_directory(path));
      CHECK_THROWS_WITH_AS(FolderLock{path}, doctest::Contains("another run"), Error);
    }
    CHECK_FALSE(fs::exists(path));
    fs::create_directory(path);
    { const FolderLock held(path); }
    CHECK(fs::exists(path));
    { const FolderLock again(path); }
    write_file_atomically(folder / "file", "x");
    CHECK_THROWS_AS(FolderLock(folder / "file"), IoError);
  }

  TEST_CASE("overwrite deletes what sphgeo wrote and nothing else") {
    const test::TemporaryFolder folder;
    const RunFolder run(folder / "run");
    const std::string mine[] = {run.summary(),        run.run_csv(),      run.resolved_deck(),
                                run.checkpoint(),     run.probe_csv("p"), run.pvd("water"),
                                run.frame("water", 0)};
    for (const std::string& f : mine) write_file_atomically(f, "# sphgeo: x\n");
    write_file_atomically(run.frame("water", 1) + ".part", "half");
    const std::string foreign[] = {run.path() + "/notes.txt", run.path() + "/probes/measured.csv",
                                   run.path() + "/frames/picture.png",
                                   run.path() + "/frames/other.vtu"};
    for (const std::string& f : foreign) write_file_atomically(f, "time,p\n0,1\n");
    RunFolder(run.path(), ExistingResults::overwrite);
    for (const std::string& f : mine) CHECK_FALSE(fs::exists(f));
    CHECK_FALSE(fs::exists(run.frame("water", 1) + ".part"));
    for (const std::string& f : foreign) CHECK(fs::exists(f));
    CHECK_FALSE(holds_results(run.path()));
  }

  TEST_CASE("a run folder that cannot be made is an input-output failure") {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "file", "x");
    CHECK(io_failure([&] { RunFolder run(folder / "file"); }).find("Not a directory") !=
          std::string::npos);
    CHECK(io_failure([&] {
            RunFolder run(folder / "file/none");
          }).find("cannot create the folder") != std::string::npos);
  }

  TEST_CASE("names of the deck become safe file names") {
    CHECK(file_name_of("p1.left_a-b") == "p1.left_a-b");
    CHECK(file_name_of("../x y") == "%2E.%2Fx%20y");
    CHECK(file_name_of("") == "unnamed");
  }
}
