#pragma once
// The state of a scene in memory, for tests of what is saved and taken back.

#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/state_io.h"

namespace sphgeo::test {

/// Keeps what is put, and gives it back.
class MemoryState final : public StateSink, public StateSource {
 public:
  void put(const std::string& name, std::span<const double> values, int = 1) override {
    keep(name, values);
  }
  void put(const std::string& name, std::span<const std::int32_t> values) override {
    keep(name, values);
  }
  void put(const std::string& name, std::span<const std::int64_t> values) override {
    keep(name, values);
  }
  void put(const std::string& name, std::span<const std::uint64_t> values) override {
    keep(name, values);
  }
  void put_text(const std::string& name, std::string_view text) override {
    arrays_[name] = std::string(text);
  }

  bool has(const std::string& name) const override { return arrays_.contains(name); }
  std::size_t size(const std::string& name) const override {
    return std::visit([](const auto& values) { return values.size(); }, at(name));
  }
  void get(const std::string& name, std::span<double> values) const override { give(name, values); }
  void get(const std::string& name, std::span<std::int32_t> values) const override {
    give(name, values);
  }
  void get(const std::string& name, std::span<std::int64_t> values) const override {
    give(name, values);
  }
  void get(const std::string& name, std::span<std::uint64_t> values) const override {
    give(name, values);
  }
  std::string text(const std::string& name) const override {
    return std::get<std::string>(at(name));
  }

 private:
  using Array = std::variant<std::vector<double>, std::vector<std::int32_t>,
                             std::vector<std::int64_t>, std::vector<std::uint64_t>, std::string>;

  const Array& at(const std::string& name) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) throw IoError("memory", "there is no " + name);
    return found->second;
  }
  template <class T>
  void keep(const std::string& name, std::span<const T> values) {
    arrays_[name] = std::vector<T>(values.begin(), values.end());
  }
  template <class T>
  void give(const std::string& name, std::span<T> values) const {
    const auto* kept = std::get_if<std::vector<T>>(&at(name));
    if (!kept || kept->size() != values.size()) throw IoError("memory", "another " + name);
    std::copy(kept->begin(), kept->end(), values.begin());
  }

  std::map<std::string, Array> arrays_;
};

}  // namespace sphgeo::test
