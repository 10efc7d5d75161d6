#include "output/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"

namespace sphgeo {

namespace fs = std::filesystem;

namespace {

// resolved.yaml last: while results are being deleted the folder still has their deck.
constexpr std::array own_files = {
    "summary.json", "run.csv",    "checkpoint.h5", "checkpoint.prev.h5",
    "report.html",  "relaxed.h5", "stop",          "resolved.yaml"};
constexpr std::array own_folders = {"probes", "frames"};

/// Whether sphgeo wrote this file of probes/ or frames/: the ending is one of ours and the text
/// begins with our mark. A file that was left half-written by a kill (.part) counts by its name.
bool is_own(const fs::path& file) {
  std::string ending = file.extension().string();
  if (ending == ".part") return true;
  if (ending != ".csv" && ending != ".vtu" && ending != ".pvd") return false;
  std::array<char, 64> head{};
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), head.size());
  return std::string_view(head.data(), static_cast<std::size_t>(in.gcount())).find("sphgeo") !=
         std::string_view::npos;
}

/// The files of earlier results, in the order in which they are deleted.
std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const char* name : own_folders)
    for (const auto& entry : fs::directory_iterator(folder / name, ignored))
      if (entry.is_regular_file(ignored) && is_own(entry.path())) found.push_back(entry.path());
  for (const char* name : own_files)
    for (const char* ending : {".part", ""}) {
      const fs::path file = folder / (std::string(name) + ending);
      if (fs::is_regular_file(file, ignored)) found.push_back(file);
    }
  return found;
}

void check(const std::error_code& error, const fs::path& path, const std::string& what) {
  if (error) throw IoError(path.string(), what + ": " + error.message());
}

}  // namespace

RunFolder::RunFolder(std::string path, ExistingResults existing) : path_(std::move(path)) {
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  if (existing != ExistingResults::resume) {
    const std::vector<fs::path> old = results_in(path_);
    if (!old.empty() && existing == ExistingResults::refuse)
      throw Error(
          ExitCode::usage,
          fmt::format(
              "{}: the folder holds results ({}{}); {}replace them with --overwrite, or name "
              "another folder with -o",
              path_, old.back().filename().string(),
              old.size() > 1 ? fmt::format(" and {} more files", old.size() - 1) : "",
              fs::exists(checkpoint()) ? "continue with --resume, " : ""));
    for (const fs::path& file : old) {
      std::error_code error;
      fs::remove(file, error);
      check(error, file, "cannot delete the earlier result");
    }
  }
  for (const char* name : own_folders) {
    std::error_code error;
    const fs::path folder = fs::path(path_) / name;
    fs::create_directories(folder, error);
    check(error, folder, "cannot create the folder");
  }
}

std::string RunFolder::probe_csv(const std::string& probe) const {
  return fmt::format("{}/probes/{}.csv", path_, file_name_of(probe));
}

std::string RunFolder::pvd(const std::string& set) const {
  return fmt::format("{}/frames/{}.pvd", path_, file_name_of(set));
}

std::string RunFolder::frame(const std::string& set, Index number) const {
  return fmt::format("{}/frames/{}", path_, frame_name(set, number));
}

std::string RunFolder::frame_name(const std::string& set, Index number) {
  return fmt::format("{}_{:06}.vtu", file_name_of(set), number);
}

FolderLock::FolderLock(const std::string& folder) : folder_(folder) {
  std::error_code error;
  created_ = fs::create_directories(folder_, error);
  check(error, folder_, "cannot create the folder");
  descriptor_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) throw_io_error(folder_, "cannot open the folder", errno);
  // File systems without locks answer with another error; they go unlocked.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw Error(ExitCode::usage,
              folder_ +
                  ": another run is writing to this folder; wait for it or stop it, or name "
                  "another folder with -o");
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
  if (created_) ::rmdir(folder_.c_str());
}

bool holds_results(const std::string& path) { return !results_in(path).empty(); }

std::string file_name_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || (c == '.' && !out.empty());
    if (plain) out += c;
    else out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out.empty() ? "unnamed" : out;
}

}  // namespace sphgeo
