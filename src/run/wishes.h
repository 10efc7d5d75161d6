#pragma once
// Fields that a run requests from the planner.

#include <string>
#include <vector>

#include "deck/model.h"
#include "plan/plan.h"

namespace sphgeo {

/// Fields that a frame of a set shows when the deck names none; `mixed`: water and soil meet.
std::vector<std::string> usual_fields(const std::string& set, bool mixed);

/// Fields requested by the deck's probes and frames, with who requests them.
std::vector<Wish> wishes_of(const Model& model, const std::vector<std::string>& sets);

/// The same for the sets of a world.
template <int Dim>
std::vector<Wish> wishes_of(const Model& model, const World<Dim>& world) {
  std::vector<std::string> names;
  for (const auto& set : world.sets()) names.push_back(set->name());
  return wishes_of(model, names);
}

}  // namespace sphgeo
