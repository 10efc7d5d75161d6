#pragma once
// checkpoint.h5: the state of a run, so that it can go on later with the same bits.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/state_io.h"

namespace sphgeo {

/// Collects the state in an HDF5 file that exists in memory only. HDF5 never writes to the disk itself:
/// version 1.10.8 crashes at exit after a full disk. Behind the HDF5 data the file carries one line with
/// its length and checksum.
class CheckpointWriter final : public StateSink {
 public:
  /// `expected_bytes` is the size of the arrays to come: it saves growing the memory in steps.
  explicit CheckpointWriter(std::size_t expected_bytes = 0);
  ~CheckpointWriter() override;

  void put(const std::string& name, std::span<const double> values, int components = 1) override;
  void put(const std::string& name, std::span<const std::int32_t> values) override;
  void put(const std::string& name, std::span<const std::int64_t> values) override;
  void put(const std::string& name, std::span<const std::uint64_t> values) override;
  void put_text(const std::string& name, std::string_view text) override;

  /// Writes the file under a temporary name, flushes it to the disk and renames it; a file that is there
  /// already is kept as `previous`. Returns its bytes. To be called once, last. Throws IoError; the
  /// earlier checkpoint is then where it was.
  std::uint64_t write(const std::string& path, const std::string& previous);

 private:
  struct Image;
  std::unique_ptr<Image> image_;
};

/// A checkpoint in memory, checked against its length and checksum before HDF5 sees it.
class CheckpointReader final : public StateSource {
 public:
  /// Throws IoError when the file cannot be read, is cut short or damaged, or is none of ours.
  explicit CheckpointReader(const std::string& path);
  /// The same from the bytes of a file; `path` stands in errors.
  CheckpointReader(std::string bytes, const std::string& path);
  ~CheckpointReader() override;

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

/// The newest sound checkpoint of a run.
struct FoundCheckpoint {
  std::unique_ptr<CheckpointReader> reader;  ///< null when there is none at all
  std::string path;
  std::vector<std::string> warnings;  ///< what was wrong with a newer one
};

/// Opens `path`, or `previous` when that is missing or damaged. Throws IoError when there are
/// checkpoints and all are damaged.
FoundCheckpoint find_checkpoint(const std::string& path, const std::string& previous);

}  // namespace sphgeo
