#include "sph/record_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace sphgeo {

const char* access_name(Access access) {
  switch (access) {
    case Access::read:
      return "read";
    case Access::write:
      return "write";
    case Access::add:
      return "add";
    case Access::update:
      return "update";
    case Access::previous:
      return "previous";
    case Access::scratch:
      return "scratch";
  }
  return "";
}

template <int Dim>
void RecordStore<Dim>::resize(const std::string& set, Index n, const FixedPoint<Dim>& frame,
                              bool single) {
  for (auto& [key, arrays] : arrays_) {
    if (key.first != set) continue;
    if (single) arrays.single.resize(n, frame);
    else arrays.full.resize(n, frame);
  }
}

template <int Dim>
std::size_t RecordStore<Dim>::bytes(const std::string& set, int array) const {
  const auto found = arrays_.find({set, array});
  return found == arrays_.end() ? 0 : found->second.bytes();
}

template <int Dim>
std::size_t RecordStore<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& [key, arrays] : arrays_) sum += arrays.bytes();
  return sum;
}

template <int Dim>
void RecordStore<Dim>::check(const std::string& set, const RecordSpec& record, bool writes) const {
  const bool named = std::any_of(uses_.begin(), uses_.end(), [&](const RecordUse& use) {
    return use.record == &record && use.set == set &&
           (!writes || (use.access != Access::read && use.access != Access::previous));
  });
  if (!named)
    throw std::logic_error(
        fmt::format("effect '{}' {} record '{}' of set '{}', which is not among "
                    "its needs",
                    effect_, writes ? "packs" : "reads", record.name, set));
}

template <int Dim>
void RecordStore<Dim>::refuse_missing(const std::string& set, int array) {
  throw std::logic_error(fmt::format("no effect needs record array {} of set '{}'", array, set));
}

template class RecordStore<2>;
template class RecordStore<3>;

}  // namespace sphgeo
