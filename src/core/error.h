#pragma once
// Failures that end the program, each tied to one exit code.

#include <optional>
#include <stdexcept>
#include <string>

#include "core/diagnostic.h"
#include "core/types.h"

namespace sphgeo {

enum class ExitCode {
  done = 0,
  internal = 1,
  usage = 2,
  unstable = 3,
  mismatch = 4,
  io = 5,
  stopped = 6
};

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
  explicit DeckError(Diagnostics d)
      : Error(ExitCode::usage, "the deck has errors"), diagnostics(std::move(d)) {}
  Diagnostics diagnostics;
};

/// A file or the disk failed: the path, what was tried, and the system's own words.
class IoError : public Error {
 public:
  IoError(const std::string& path, const std::string& what)
      : Error(ExitCode::io, path + ": " + what) {}
};

/// Where and when a run became unstable.
struct Instability {
  std::string cause;   ///< one word: not_finite, speed, density, step, lost, penetration ...
  std::string effect;  ///< whose result it is, "" when unknown
  std::string set;
  std::optional<Id> particle;
  std::optional<Vec3> place;   ///< m
  std::optional<double> time;  ///< s
};

/// The guard stopped the run.
class UnstableError : public Error {
 public:
  UnstableError(const std::string& what, Instability where)
      : Error(ExitCode::unstable, what), instability(std::move(where)) {}
  Instability instability;
};

}  // namespace sphgeo
