#pragma once
// Failures that end the program, each tied to one exit code.

#include <stdexcept>
#include <string>

#include "core/diagnostic.h"

namespace sphgeo {

enum class ExitCode { done = 0, internal = 1, usage = 2, unstable = 3, mismatch = 4, io = 5, stopped = 6 };

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& what) : std::runtime_error(what), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The deck or the command line is wrong; carries every finding.
class DeckError : public Error {
 public:
  explicit DeckError(Diagnostics d) : Error(ExitCode::usage, "the deck has errors"), diagnostics(std::move(d)) {}
  Diagnostics diagnostics;
};

/// A file or the disk failed: the path, what was tried, and the system's own words.
class IoError : public Error {
 public:
  IoError(const std::string& path, const std::string& what) : Error(ExitCode::io, path + ": " + what) {}
};

/// The guard stopped the run.
class UnstableError : public Error {
 public:
  explicit UnstableError(const std::string& what) : Error(ExitCode::unstable, what) {}
};

}  // namespace sphgeo
