#include "effects/effect.h"

#include <algorithm>

namespace sphgeo {

const char* stage_name(Stage stage) {
  switch (stage) {
    case Stage::exchange:
      return "exchange";
    case Stage::reinitialize:
      return "reinitialize";
    case Stage::predict:
      return "predict";
    case Stage::force:
      return "force";
    case Stage::kick:
      return "kick";
    case Stage::rate:
      return "rate";
    case Stage::correct:
      return "correct";
    case Stage::solid_predict:
      return "solid_predict";
    case Stage::solid_force:
      return "solid_force";
    case Stage::solid_kick:
      return "solid_kick";
    case Stage::solid_finish:
      return "solid_finish";
    case Stage::observe:
      return "observe";
  }
  return "";
}

std::vector<EffectRegistry::Entry>& EffectRegistry::entries() {
  static std::vector<Entry> list;
  return list;
}

const std::vector<EffectRegistry::Entry>& EffectRegistry::all() {
  // Registration order is the link order; sorted once by name to be independent of it.
  static const std::vector<Entry>& sorted = []() -> std::vector<Entry>& {
    auto& list = entries();
    std::sort(list.begin(), list.end(),
              [](const Entry& a, const Entry& b) { return a.info.name < b.info.name; });
    return list;
  }();
  return sorted;
}

}  // namespace sphgeo
