#include "output/csv.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"

namespace sphgeo {

namespace {

constexpr std::size_t pending_limit = std::size_t{1} << 16;

/// A legend is one line each.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string csv_head(const std::string& title, const std::vector<Column>& columns) {
  std::string head = fmt::format("# sphgeo: {}\n", one_line(title));
  for (const Column& c : columns)
    head += fmt::format("# {}: {}\n", one_line(c.heading()), one_line(c.sentence));
  for (std::size_t i = 0; i < columns.size(); ++i)
    head += (i == 0 ? "" : ",") + csv_cell(one_line(columns[i].heading()));
  return head + '\n';
}

CsvWriter::CsvWriter(const std::string& path, std::size_t columns, double flush_seconds)
    : path_(path), columns_(columns), flush_seconds_(flush_seconds) {}

CsvWriter::CsvWriter(const std::string& path, const std::string& title,
                     const std::vector<Column>& columns, double flush_seconds)
    : CsvWriter(path, columns.size(), flush_seconds) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw_io_error(path, "cannot create the file", errno);
  pending_ = csv_head(title, columns);
  flush();
}

CsvWriter CsvWriter::resume(const std::string& path, const std::string& title,
                            const std::vector<Column>& columns, std::uint64_t offset,
                            double flush_seconds) {
  const std::string head = csv_head(title, columns);
  const std::string text = read_file(path);
  if (text.size() < offset)
    throw IoError(
        path, fmt::format("{} bytes, but the checkpoint was written at {}", text.size(), offset));
  if (offset < head.size() || !text.starts_with(head))
    throw IoError(path, "its columns are not those of this run");
  if (text[offset - 1] != '\n') throw IoError(path, "changed since the checkpoint was written");
  CsvWriter csv(path, columns.size(), flush_seconds);
  csv.descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (csv.descriptor_ < 0) throw_io_error(path, "cannot open the file", errno);
  const auto end = static_cast<off_t>(offset);
  if (::ftruncate(csv.descriptor_, end) != 0 || ::lseek(csv.descriptor_, end, SEEK_SET) < 0)
    throw_io_error(path, "cannot cut the file back to the checkpoint", errno);
  csv.flushed_ = offset;
  return csv;
}

CsvWriter::CsvWriter(CsvWriter&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(other.columns_),
      flush_seconds_(other.flush_seconds_),
      descriptor_(std::exchange(other.descriptor_, -1)),
      pending_(std::exchange(other.pending_, {})),
      flushed_(other.flushed_),
      last_flush_(other.last_flush_) {}

CsvWriter& CsvWriter::operator=(CsvWriter&& other) noexcept {
  if (this == &other) return *this;
  close();
  path_ = std::move(other.path_);
  columns_ = other.columns_;
  flush_seconds_ = other.flush_seconds_;
  descriptor_ = std::exchange(other.descriptor_, -1);
  pending_ = std::exchange(other.pending_, {});
  flushed_ = other.flushed_;
  last_flush_ = other.last_flush_;
  return *this;
}

CsvWriter::~CsvWriter() { close(); }

void CsvWriter::close() noexcept {
  if (descriptor_ < 0) return;
  try {
    flush();
  } catch (const std::exception&) {  // a destructor must not throw; flush() reports
  }
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

void CsvWriter::row(std::span<const double> values) {
  if (values.size() != columns_)
    throw std::invalid_argument(
        fmt::format("{}: {} values for {} columns", path_, values.size(), columns_));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) pending_ += ',';
    if (std::isfinite(values[i])) fmt::format_to(std::back_inserter(pending_), "{}", values[i]);
  }
  pending_ += '\n';
  const std::chrono::duration<double> age = std::chrono::steady_clock::now() - last_flush_;
  if (pending_.size() >= pending_limit || age.count() >= flush_seconds_) flush();
}

void CsvWriter::flush(bool to_disk) {
  last_flush_ = std::chrono::steady_clock::now();
  // Rows of a file without a name, or behind a gap, are lost when the run ends.
  struct stat file {};
  if (::fstat(descriptor_, &file) == 0 && S_ISREG(file.st_mode)) {
    if (file.st_nlink == 0) throw IoError(path_, "was removed while the run was writing it");
    if (file.st_size != static_cast<off_t>(flushed_))
      throw IoError(path_, "was changed by another program while the run was writing it");
  }
  if (!pending_.empty()) {
    try {
      write_all(descriptor_, pending_.data(), pending_.size(), path_);
    } catch (const IoError&) {
      // Whole rows only; the rows stay pending, so that a later flush may succeed.
      const auto end = static_cast<off_t>(flushed_);
      if (::ftruncate(descriptor_, end) == 0) ::lseek(descriptor_, end, SEEK_SET);
      throw;
    }
    flushed_ += pending_.size();
    pending_.clear();
  }
  if (to_disk) wait_for_disk();
}

void CsvWriter::wait_for_disk() const {
  if (::fsync(descriptor_) != 0) throw_io_error(path_, "cannot flush to the disk", errno);
}

}  // namespace sphgeo
