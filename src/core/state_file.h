#pragma once
// Named arrays in an HDF5 file that appears whole or not at all, and that shows damage.

#include <cstdint>
#include <memory>
#include <string>

#include "core/state_io.h"

namespace sphgeo {

/// What a file holds.
struct StateFileKind {
  std::string mark;  ///< stands in its last line, with the version of the layout: "checkpoint 5"
  std::string noun;  ///< in errors: "checkpoint"
};

/// Collects the state in an HDF5 file that exists in memory only. HDF5 never writes to the disk
/// itself: version 1.10.8 crashes at exit after a full disk. Behind the HDF5 data the file carries
/// one line with its length and checksum.
class StateFileWriter : public StateSink {
 public:
  /// `expected_bytes` is the size of the arrays to come: it saves growing the memory in steps.
  explicit StateFileWriter(StateFileKind kind, std::size_t expected_bytes = 0);
  ~StateFileWriter() override;

  void put(const std::string& name, std::span<const double> values, int components = 1) override;
  void put(const std::string& name, std::span<const std::int32_t> values) override;
  void put(const std::string& name, std::span<const std::int64_t> values) override;
  void put(const std::string& name, std::span<const std::uint64_t> values) override;
  void put_text(const std::string& name, std::string_view text) override;

  /// Ends the collecting, and all use of HDF5, which knows one thread only: what is left is memory,
  /// which any thread may write and release. Returns the bytes that the file will have.
  std::uint64_t finish();
  /// Writes the file under a temporary name, flushes it to the disk and renames it; a file that is
  /// there already is kept as `previous`, unless that is empty. To be called once, last; it
  /// finishes what is not finished yet. Returns its bytes. Throws IoError; the earlier file is then
  /// where it was.
  std::uint64_t write(const std::string& path, const std::string& previous);

 private:
  struct Image;
  StateFileKind kind_;
  std::unique_ptr<Image> image_;
  std::uint64_t bytes_ = 0;  ///< of the HDF5 data, once it is finished
};

/// Such a file in memory, checked against its length and checksum before HDF5 sees it.
class StateFileReader : public StateSource {
 public:
  /// Throws IoError when the file cannot be read, is cut short or damaged, or is none of ours.
  StateFileReader(StateFileKind kind, const std::string& path);
  /// The same from the bytes of a file; `path` stands in errors.
  StateFileReader(StateFileKind kind, std::string bytes, const std::string& path);
  ~StateFileReader() override;

  bool has(const std::string& name) const override;
  std::size_t size(const std::string& name) const override;
  void get(const std::string& name, std::span<double> values) const override;
  void get(const std::string& name, std::span<std::int32_t> values) const override;
  void get(const std::string& name, std::span<std::int64_t> values) const override;
  void get(const std::string& name, std::span<std::uint64_t> values) const override;
  std::string text(const std::string& name) const override;

 private:
  struct Image;
  std::unique_ptr<Image> image_;
};

}  // namespace sphgeo
