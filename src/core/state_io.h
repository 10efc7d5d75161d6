#pragma once
// How the parts of a running scene hand over what must survive a restart: named arrays of numbers.
// A checkpoint is one implementation; nothing below `output` knows the file format.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace sphgeo {

/// Takes the state. Names are paths such as "sets/water/velocity", each used once.
class StateSink {
 public:
  virtual ~StateSink() = default;
  /// Values in rows of `components` numbers.
  virtual void put(const std::string& name, std::span<const double> values, int components = 1) = 0;
  virtual void put(const std::string& name, std::span<const std::int32_t> values) = 0;
  virtual void put(const std::string& name, std::span<const std::int64_t> values) = 0;
  virtual void put(const std::string& name, std::span<const std::uint64_t> values) = 0;
  virtual void put_text(const std::string& name, std::string_view text) = 0;

  void put_number(const std::string& name, double value) {
    put(name, std::span<const double>(&value, 1));
  }
  void put_count(const std::string& name, std::int64_t value) {
    put(name, std::span<const std::int64_t>(&value, 1));
  }
};

/// Gives it back. Every function throws IoError when the name is missing or holds something else.
class StateSource {
 public:
  virtual ~StateSource() = default;
  virtual bool has(const std::string& name) const = 0;
  /// Numbers in the array: rows times components.
  virtual std::size_t size(const std::string& name) const = 0;
  /// Fills `values`, whose size must be that of the array.
  virtual void get(const std::string& name, std::span<double> values) const = 0;
  virtual void get(const std::string& name, std::span<std::int32_t> values) const = 0;
  virtual void get(const std::string& name, std::span<std::int64_t> values) const = 0;
  virtual void get(const std::string& name, std::span<std::uint64_t> values) const = 0;
  virtual std::string text(const std::string& name) const = 0;

  double number(const std::string& name) const {
    double value = 0;
    get(name, std::span<double>(&value, 1));
    return value;
  }
  std::int64_t count(const std::string& name) const {
    std::int64_t value = 0;
    get(name, std::span<std::int64_t>(&value, 1));
    return value;
  }
};

}  // namespace sphgeo
