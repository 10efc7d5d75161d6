#include "deck/registry.h"

#include <algorithm>
#include <stdexcept>

namespace sphgeo {

const RegistryEntry* RegistryCore::find(const std::string& name) const {
  for (const RegistryEntry& e : entries_) {
    if (e.name == name) return &e;
  }
  return nullptr;
}

std::vector<std::string> RegistryCore::names() const {
  std::vector<std::string> out;
  for (const RegistryEntry& e : entries_) out.push_back(e.name);
  return out;
}

void RegistryCore::add(RegistryEntry entry) {
  if (find(entry.name) != nullptr) {
    throw std::logic_error("two types of " + interface_name_ + " are called " + entry.name);
  }
  // Sorted, so that nothing depends on the order in which files are linked.
  const auto place = std::lower_bound(
      entries_.begin(), entries_.end(), entry.name,
      [](const RegistryEntry& e, const std::string& name) { return e.name < name; });
  entries_.insert(place, std::move(entry));
}

}  // namespace sphgeo
