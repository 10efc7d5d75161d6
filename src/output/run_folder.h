#pragma once
// The folder of a run: its files, and which of them may be deleted.

#include <string>

#include "core/types.h"

namespace sphgeo {

/// What to do with a folder that already holds results.
enum class ExistingResults { refuse, overwrite, resume };

/// The layout of a run folder: resolved.yaml, summary.json, run.csv, probes/*.csv, frames/*.vtu and
/// .pvd, checkpoint.h5, report.html.
class RunFolder {
 public:
  /// Creates the folder with probes/ and frames/. A folder that holds results is refused
  /// (Error with exit code usage) unless told otherwise; `overwrite` deletes the files that sphgeo
  /// itself has written and nothing else. Throws IoError with the path when the system refuses.
  explicit RunFolder(std::string path, ExistingResults existing = ExistingResults::refuse);

  const std::string& path() const { return path_; }
  std::string resolved_deck() const { return path_ + "/resolved.yaml"; }
  std::string summary() const { return path_ + "/summary.json"; }
  std::string run_csv() const { return path_ + "/run.csv"; }
  std::string checkpoint() const { return path_ + "/checkpoint.h5"; }
  std::string previous_checkpoint() const { return path_ + "/checkpoint.prev.h5"; }
  std::string relaxed() const { return path_ + "/relaxed.h5"; }  ///< of `sphgeo relax`
  std::string report() const { return path_ + "/report.html"; }
  std::string stop_file() const { return path_ + "/stop"; }  ///< asks a run to stop when it appears
  std::string probe_csv(const std::string& probe) const;
  std::string pvd(const std::string& set) const;
  /// frames/SET_000012.vtu
  std::string frame(const std::string& set, Index number) const;
  /// The same, as the .pvd file names it: relative to frames/.
  static std::string frame_name(const std::string& set, Index number);

 private:
  std::string path_;
};

/// Locks a folder against other runs during its lifetime; the system releases the lock however the
/// process ends.
class FolderLock {
 public:
  /// Creates the folder when it is missing. Throws Error (usage) when another run holds it,
  /// IoError.
  explicit FolderLock(const std::string& folder);
  /// An unused new folder is removed again.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::string folder_;
  bool created_ = false;
  int descriptor_ = -1;
};

/// Whether a folder holds files that a run has written.
bool holds_results(const std::string& path);

/// A name of the deck as a file name: characters but letters, digits, '.', '_', '-' become %XX.
std::string file_name_of(const std::string& name);

}  // namespace sphgeo
