#include "core/state_file.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <sys/mman.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace sphgeo {
namespace {

constexpr std::size_t trailer_bytes =
    72;  // a line end, the mark, two numbers of 16 digits, padding

/// What the line behind the data begins with.
std::string mark_of(const StateFileKind& kind) { return fmt::format("\nsphgeo {} ", kind.mark); }

/// The line behind the data.
std::string trailer(const StateFileKind& kind, const void* data, std::size_t bytes) {
  return fmt::format("{:<{}}\n",
                     fmt::format("{}{:016x} {:016x}", mark_of(kind), bytes, checksum(data, bytes)),
                     trailer_bytes - 1);
}

/// An HDF5 object that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {
    if (id < 0) throw Error(ExitCode::internal, "HDF5 refused to build a file in memory");
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }
  void close() {
    if (close_(std::exchange(id_, -1)) < 0)
      throw Error(ExitCode::internal, "HDF5 could not close a file in memory");
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

template <class T>
hid_t stored_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  else if constexpr (std::is_same_v<T, std::int32_t>) return H5T_STD_I32LE;
  else if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  else if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_STD_U64LE;
  else return H5T_STD_U8LE;
}
template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  else if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
  else return H5T_NATIVE_UINT8;
}

/// HDF5 prints every failure on stderr by itself, which is ours; and its exit handler may touch
/// files.
void tame_hdf5() {
  static const bool once = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  (void)once;
}

/// HDF5 knows its files by name: no two that live at once may share one, nor that of a file on
/// disk.
std::string unique_name(const void* of) { return fmt::format("sphgeo state in memory {}", of); }

/// The memory of an in-memory file, taken over when HDF5 lets go of it: the image is never copied.
/// Whole pages, as AtomicFile wants them; all threads ask the system for them, which takes as long
/// as filling them.
struct Taken {
  void* data = nullptr;
  std::size_t bytes = 0;

  bool grow(std::size_t n) {
    void* p = data ? ::mremap(data, bytes, n, MREMAP_MAYMOVE)
                   : ::mmap(nullptr, n, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) return false;
    constexpr std::size_t piece = std::size_t{4} << 20;
    const std::size_t first = data ? bytes / piece : 0;
    data = p;
    bytes = n;
#if defined(MADV_HUGEPAGE)
    ::madvise(p, n, MADV_HUGEPAGE);
#endif
#if defined(MADV_POPULATE_WRITE)
    parallel_blocks(static_cast<Index>((n + piece - 1) / piece - first), 1,
                    [&](Index begin, Index, Index) {
                      const std::size_t at = (first + static_cast<std::size_t>(begin)) * piece;
                      ::madvise(static_cast<char*>(data) + at, std::min(piece, n - at),
                                MADV_POPULATE_WRITE);  // later, if not now
                    });
#endif
    return true;
  }
  void release() {
    if (data) ::munmap(data, bytes);
    data = nullptr;
  }
};
void* image_malloc(std::size_t n, H5FD_file_image_op_t, void* user) {
  Taken& taken = *static_cast<Taken*>(user);
  return taken.grow(n) ? taken.data : nullptr;
}
void* image_realloc(void*, std::size_t n, H5FD_file_image_op_t op, void* user) {
  return image_malloc(n, op, user);
}
herr_t image_free(void*, H5FD_file_image_op_t op, void* user) {
  if (op != H5FD_FILE_IMAGE_OP_FILE_CLOSE) static_cast<Taken*>(user)->release();
  return 0;
}
void* share_user(void* user) { return user; }
herr_t leave_user(void*) { return 0; }

}  // namespace

struct StateFileWriter::Image {
  Taken taken;
  Handle file;
  Handle links;  ///< makes the groups of a path on the way

  explicit Image(std::size_t expected)
      : file(create(expected, taken)), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose) {
    H5Pset_create_intermediate_group(links, 1);
  }
  ~Image() {
    if (file >= 0) file.close();
    taken.release();
  }
  void close() {
    links.close();
    file.close();
  }

  static Handle create(std::size_t expected, Taken& taken) {
    tame_hdf5();
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // In pieces: what is added to the arrays is mostly small, and HDF5 fills each whole piece with
    // zeros.
    H5Pset_fapl_core(access, expected / 16 + (1u << 18), false);
    H5FD_file_image_callbacks_t calls{image_malloc, nullptr,    image_realloc, image_free,
                                      share_user,   leave_user, &taken};
    if (H5Pset_file_image_callbacks(access, &calls) < 0)
      throw Error(ExitCode::internal, "HDF5 refused to build a file in memory");
    return {H5Fcreate(unique_name(&taken).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose};
  }

  template <class T>
  void put(const std::string& name, const T* values, std::size_t rows, int components) {
    const hsize_t extent[2] = {rows, static_cast<hsize_t>(components)};
    const Handle space(rows == 0 ? H5Screate(H5S_NULL)
                                 : H5Screate_simple(components == 1 ? 1 : 2, extent, nullptr),
                       H5Sclose);
    const Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(options, false);  // the same state gives the same file
    const Handle set(
        H5Dcreate2(file, name.c_str(), stored_type<T>(), space, links, options, H5P_DEFAULT),
        H5Dclose);
    if (rows > 0 && H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
      throw Error(ExitCode::internal, "there is not enough memory to build an HDF5 file");
  }
};

StateFileWriter::StateFileWriter(StateFileKind kind, std::size_t expected_bytes)
    : kind_(std::move(kind)), image_(std::make_unique<Image>(expected_bytes)) {}
StateFileWriter::~StateFileWriter() = default;

void StateFileWriter::put(const std::string& name, std::span<const double> values, int components) {
  image_->put(name, values.data(), values.size() / static_cast<std::size_t>(components),
              components);
}
void StateFileWriter::put(const std::string& name, std::span<const std::int32_t> values) {
  image_->put(name, values.data(), values.size(), 1);
}
void StateFileWriter::put(const std::string& name, std::span<const std::int64_t> values) {
  image_->put(name, values.data(), values.size(), 1);
}
void StateFileWriter::put(const std::string& name, std::span<const std::uint64_t> values) {
  image_->put(name, values.data(), values.size(), 1);
}
void StateFileWriter::put_text(const std::string& name, std::string_view text) {
  image_->put(name, reinterpret_cast<const unsigned char*>(text.data()), text.size(), 1);
}

std::uint64_t StateFileWriter::finish() {
  if (bytes_ > 0) return bytes_ + trailer_bytes;
  hsize_t bytes = 0;
  if (H5Fflush(image_->file, H5F_SCOPE_GLOBAL) < 0 || H5Fget_filesize(image_->file, &bytes) < 0)
    throw Error(ExitCode::internal, "HDF5 could not finish a file in memory");
  image_->close();
  bytes_ = bytes;
  return bytes_ + trailer_bytes;
}

std::uint64_t StateFileWriter::write(const std::string& path, const std::string& previous) {
  finish();
  const void* data = image_->taken.data;
  AtomicFile file(path, bytes_ + trailer_bytes);
  std::string line;
  parallel_blocks(2, 1, [&](Index task, Index, Index) {
    if (task == 0) file.write(data, bytes_);
    else line = trailer(kind_, data, bytes_);
  });
  file.write(line);
  file.commit(previous);
  return bytes_ + line.size();
}

struct StateFileReader::Image {
  StateFileKind kind;
  std::string path;
  Handle file;

  Image(StateFileKind of, const std::string& bytes, std::string from)
      : kind(std::move(of)), path(std::move(from)), file(open(kind, bytes, path)) {}

  static Handle open(const StateFileKind& kind, const std::string& bytes, const std::string& path) {
    const std::string_view all(bytes);
    const auto damaged = [&](const std::string& what) {
      throw IoError(path, "the " + kind.noun + " is damaged: " + what);
    };
    if (all.size() < trailer_bytes ||
        !all.substr(all.size() - trailer_bytes).starts_with(mark_of(kind)))
      damaged("its end is missing, or it is no " + kind.noun + " of this version");
    const std::size_t length = all.size() - trailer_bytes;
    if (all.substr(length) != trailer(kind, bytes.data(), length))
      damaged("its checksum does not fit");
    tame_hdf5();
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access, 1u << 20, false);
    // HDF5 copies the image; it only reads from the pointer.
    H5Pset_file_image(access, const_cast<char*>(bytes.data()), length);
    const hid_t id = H5Fopen(unique_name(&bytes).c_str(), H5F_ACC_RDONLY, access);
    if (id < 0) damaged("HDF5 cannot read it");
    return {id, H5Fclose};
  }

  Handle dataset(const std::string& name) const {
    const hid_t id = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    if (id < 0) throw IoError(path, "the " + kind.noun + " holds no '" + name + "'");
    return {id, H5Dclose};
  }

  std::size_t size(const std::string& name) const {
    const Handle set = dataset(name);
    const Handle space(H5Dget_space(set), H5Sclose);
    return static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  }

  template <class T>
  void get(const std::string& name, T* values, std::size_t n) const {
    const Handle set = dataset(name);
    const Handle type(H5Dget_type(set), H5Tclose);
    if (H5Tequal(type, stored_type<T>()) <= 0)
      throw IoError(path, "'" + name + "' of the " + kind.noun + " holds numbers of another kind");
    if (const std::size_t there = size(name); there != n)
      throw IoError(path, fmt::format("'{}' of the {} has {} numbers where this run has {}", name,
                                      kind.noun, there, n));
    if (n > 0 && H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
      throw IoError(path, "'" + name + "' of the " + kind.noun + " cannot be read");
  }
};

StateFileReader::StateFileReader(StateFileKind kind, const std::string& path)
    : StateFileReader(std::move(kind), read_file(path, std::uint64_t{1} << 40), path) {}
StateFileReader::StateFileReader(StateFileKind kind, std::string bytes, const std::string& path)
    : image_(std::make_unique<Image>(std::move(kind), bytes, path)) {}
StateFileReader::~StateFileReader() = default;

bool StateFileReader::has(const std::string& name) const {
  for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
    if (H5Lexists(image_->file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(image_->file, name.c_str(), H5P_DEFAULT) > 0;
}
std::size_t StateFileReader::size(const std::string& name) const { return image_->size(name); }
void StateFileReader::get(const std::string& name, std::span<double> v) const {
  image_->get(name, v.data(), v.size());
}
void StateFileReader::get(const std::string& name, std::span<std::int32_t> v) const {
  image_->get(name, v.data(), v.size());
}
void StateFileReader::get(const std::string& name, std::span<std::int64_t> v) const {
  image_->get(name, v.data(), v.size());
}
void StateFileReader::get(const std::string& name, std::span<std::uint64_t> v) const {
  image_->get(name, v.data(), v.size());
}
std::string StateFileReader::text(const std::string& name) const {
  std::string out(image_->size(name), '\0');
  image_->get(name, reinterpret_cast<unsigned char*>(out.data()), out.size());
  return out;
}

}  // namespace sphgeo
