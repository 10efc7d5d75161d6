// Runs a target without libFuzzer: every stored input, then mutations of them in a fixed sequence.
//
//   sphgeo_fuzz TARGET [--seconds S] [--runs N] [--seed K] [--corpus DIR] [--keep DIR]
//   sphgeo_fuzz TARGET FILE...          these inputs only
//
// Ends after N mutations or S seconds, whichever comes first; SPHGEO_FUZZ_SECONDS sets S and lifts
// N. A crash, an input that takes longer than 10 s, more than 3 GiB of memory, or an exception that
// escapes is a finding: its input goes to a file in DIR (default: here) and the exit code is 1.

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/hash.h"
#include "core/parallel.h"
#include "mutator.h"
#include "targets.h"

namespace {

using namespace sphgeo;
using namespace sphgeo::fuzz;

constexpr int longest_seconds = 10;
constexpr rlim_t most_memory = rlim_t{3} << 30;

// What a signal handler needs; it may not allocate.
std::string current;  // the input that is running
std::string crash_path;
alignas(16) char handler_stack[1 << 16];

void save_current() {
  const int file = ::open(crash_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0) return;
  const char* words[] = {"finding: ", crash_path.c_str(), "\n"};
  if (::write(file, current.data(), current.size()) >= 0)
    for (const char* w : words)
      if (::write(2, w, std::strlen(w)) < 0) break;
  ::close(file);
}

void on_signal(int number) {
  const char* what = number == SIGALRM ? "an input takes too long\n" : "a crash\n";
  if (::write(2, what, std::strlen(what)) >= 0) save_current();
  ::_exit(1);
}

void watch() {
  stack_t stack{};
  stack.ss_sp = handler_stack;
  stack.ss_size = sizeof handler_stack;
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_ONSTACK;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM})
    ::sigaction(number, &action, nullptr);
#if !defined(__SANITIZE_ADDRESS__)  // its shadow memory is larger than any limit
  const rlimit limit{most_memory, most_memory};
  ::setrlimit(RLIMIT_AS, &limit);
#endif
}

bool run(const Target& target, std::string input) {
  current = std::move(input);
  ::alarm(longest_seconds);
  try {
    target.run(current);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "an exception escaped: %s\n", e.what());
    save_current();
    return false;
  }
  ::alarm(0);
  return true;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

struct Options {
  double seconds = 2;
  std::size_t runs = 100000000;
  std::uint64_t seed = 1;
  std::string corpus = SPHGEO_FUZZ_CORPUS;
  std::string keep = ".";
  std::vector<std::string> files;
};

Options parse(int argc, char** argv) {
  Options o;
  const char* asked = std::getenv("SPHGEO_FUZZ_SECONDS");
  if (asked != nullptr) o.seconds = std::atof(asked);
  for (int k = 2; k < argc; ++k) {
    const std::string word = argv[k];
    if (!word.starts_with("--")) {
      o.files.push_back(word);
      continue;
    }
    const std::string value = ++k < argc ? argv[k] : "";
    if (word == "--seconds" && asked == nullptr) o.seconds = std::atof(value.c_str());
    if (word == "--runs" && asked == nullptr) o.runs = std::strtoull(value.c_str(), nullptr, 10);
    if (word == "--seed") o.seed = std::strtoull(value.c_str(), nullptr, 10);
    if (word == "--corpus") o.corpus = value;
    if (word == "--keep") o.keep = value;
  }
  return o;
}

}  // namespace

int main(int argc, char** argv) {
  const Target* target = argc > 1 ? find_target(argv[1]) : nullptr;
  if (target == nullptr) {
    std::fprintf(
        stderr,
        "usage: sphgeo_fuzz TARGET [--seconds S] [--runs N] [--seed K] [--keep DIR] [FILE...]\n");
    return 2;
  }
  const Options options = parse(argc, argv);
  set_threads(1);
  scratch_folder();
  crash_path = options.keep + "/finding-" + target->name + "-seed" + std::to_string(options.seed);
  watch();
  for (const std::string& file : options.files)
    if (!run(*target, read(file))) return 1;
  if (!options.files.empty()) return 0;

  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(options.corpus + "/" + target->name))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const auto& path : paths) {
    corpus.push_back(read(path));
    if (run(*target, corpus.back())) continue;
    std::fprintf(stderr, "stored input: %s\n", path.c_str());
    return 1;
  }
  if (corpus.empty()) {
    std::fprintf(stderr, "no stored inputs for '%s'\n", target->name);
    return 1;
  }
  Mutator mutator(options.seed, read_words(options.corpus + "/" + target->name + ".dict"),
                  target->longest);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::size_t runs = 0;
  for (; runs < options.runs && seconds() < options.seconds; ++runs)
    if (!run(*target, mutator.next(corpus[mutator.below(corpus.size())],
                                   corpus[mutator.below(corpus.size())])))
      return 1;
  std::printf("%s: %zu stored inputs, %zu mutations in %.1f s, no finding\n", target->name,
              corpus.size(), runs, seconds());
  return 0;
}
