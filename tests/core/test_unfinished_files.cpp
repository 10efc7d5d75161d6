#include <doctest/doctest.h>

#include <filesystem>

#include "core/atomic_file.h"
#include "core/unfinished_files.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("a signal's handler removes what is being written, and nothing else") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    const std::string done = folder / "sphgeo_test_done", open = folder / "sphgeo_test_open";
    write_file_atomically(done, "done");
    {
      AtomicFile file(open);
      file.write("begun");
      CHECK(std::filesystem::exists(open + ".part"));
      remove_unfinished_files();
      CHECK_FALSE(std::filesystem::exists(open + ".part"));
      CHECK(std::filesystem::exists(done));
    }
    // Nothing is remembered of files that have ended.
    write_file_atomically(open + ".part", "of another program");
    remove_unfinished_files();
    CHECK(std::filesystem::exists(open + ".part"));
    for (const std::string& path : {done, open + ".part"}) std::filesystem::remove(path);
  }
}
