#pragma once
// State of wave makers with active wave absorption.

#include <map>
#include <string>

#include "core/state_io.h"

namespace sphgeo {

/// Motion of a piston beside the one that the deck prescribes, along the direction of its waves.
struct PistonState {
  double wanted = 0;  ///< speed that absorbs the waves that arrive, m/s
  double lag = 0;     ///< time in which it gets to that speed, s
  double speed = 0;   ///< m/s
  double shift = 0;   ///< m
};

/// All of them, by name of the boundary. One effect says what a piston ought to do, another moves
/// it.
class Pistons {
 public:
  /// Made at the first call; the reference stays valid.
  PistonState& operator[](const std::string& boundary) { return states_[boundary]; }

  void save(StateSink& sink) const {
    for (const auto& [name, state] : states_) {
      const std::string at = "pistons/" + name + "/";
      sink.put_number(at + "wanted", state.wanted);
      sink.put_number(at + "lag", state.lag);
      sink.put_number(at + "speed", state.speed);
      sink.put_number(at + "shift", state.shift);
    }
  }
  /// Of those that exist.
  void load(const StateSource& source) {
    for (auto& [name, state] : states_) {
      const std::string at = "pistons/" + name + "/";
      state.wanted = source.number(at + "wanted");
      state.lag = source.number(at + "lag");
      state.speed = source.number(at + "speed");
      state.shift = source.number(at + "shift");
    }
  }

 private:
  std::map<std::string, PistonState> states_;
};

}  // namespace sphgeo
