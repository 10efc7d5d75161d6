/* Preloaded into the program by test_faults.py: makes one chosen system call fail.
 *
 *   SPHGEO_FAULT_FOLDER   only calls on files below this folder count
 *   SPHGEO_FAULT_LOG      every such call is appended there as a line "kind path"
 *   SPHGEO_FAULT          "kind:n:error" - the n-th call of this kind (from 1) fails with this
 * errno; "kind:n+:error" - so do all later ones: a disk stays full a failing write first takes half
 * of its bytes, as a disk that fills up does "short:1:0" - every write takes at most seven bytes,
 * and all succeed Kinds: open (for writing), write, sync, close, rename, unlink, mkdir, truncate.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void* real(const char* name) { return dlsym(RTLD_NEXT, name); }

/* write(2) and open(2) themselves, for the log. */
typedef ssize_t (*write_call)(int, const void*, size_t);
typedef int (*open_call)(const char*, int, ...);

static int in_folder(const char* path) {
  const char* folder = getenv("SPHGEO_FAULT_FOLDER");
  return folder && path && strncmp(path, folder, strlen(folder)) == 0;
}

static int chosen(const char* kind, long* first, int* further, int* error) {
  const char* fault = getenv("SPHGEO_FAULT");
  const size_t length = strlen(kind);
  if (!fault || strncmp(fault, kind, length) != 0 || fault[length] != ':') return 0;
  char* end = NULL;
  *first = strtol(fault + length + 1, &end, 10);
  *further = *end == '+';
  if (*further) ++end;
  *error = *end == ':' ? atoi(end + 1) : EIO;
  return 1;
}

/* Counts and logs a call; the error it has to fail with, or 0. */
static int fault(const char* kind, const char* path) {
  static long counts[8];
  static const char* const kinds[8] = {"open",   "write",  "sync",  "close",
                                       "rename", "unlink", "mkdir", "truncate"};
  const char* log = getenv("SPHGEO_FAULT_LOG");
  if (log) {
    char line[4400];
    const int n = snprintf(line, sizeof line, "%s %s\n", kind, path);
    const int file =
        ((open_call)real("open"))(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file >= 0) {
      if (((write_call)real("write"))(file, line, (size_t)n) < 0) abort();
      ((int (*)(int))real("close"))(file);
    }
  }
  for (int k = 0; k < 8; ++k) {
    if (strcmp(kinds[k], kind) != 0) continue;
    const long now = ++counts[k];
    long first = 0;
    int further = 0, error = 0;
    if (chosen(kind, &first, &further, &error) && (now == first || (further && now > first)))
      return error;
  }
  return 0;
}

/* Whether this call on a path has to fail; errno is then set. */
static int fails(const char* kind, const char* path) {
  const int error = in_folder(path) ? fault(kind, path) : 0;
  if (error) errno = error;
  return error != 0;
}

/* The path of an open file, "" when it has none. */
static const char* path_of(int descriptor, char path[4096]) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, 4095);
  path[n < 0 ? 0 : n] = '\0';
  return path;
}

/* The same of an open file. */
static int fails_at(const char* kind, int descriptor) {
  char path[4096];
  return fails(kind, path_of(descriptor, path));
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if ((flags & O_ACCMODE) != O_RDONLY && fails("open", path)) return -1;
  return ((open_call)real("open"))(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
  const write_call go = (write_call)real("write");
  const char* asked = getenv("SPHGEO_FAULT");
  char path[4096];
  const int failed = fails("write", path_of(descriptor, path)), error = errno;
  if (!failed) {
    const int cut = asked && strncmp(asked, "short:", 6) == 0 && in_folder(path);
    return go(descriptor, data, cut && bytes > 7 ? 7 : bytes);
  }
  /* What fits is written; the caller learns of the error now. */
  if (bytes > 1 && go(descriptor, data, bytes / 2) < 0) return -1;
  errno = error;
  return -1;
}

/* fdatasync leaves out times only, which no test looks at. */
int fsync(int descriptor) {
  return fails_at("sync", descriptor) ? -1 : ((int (*)(int))real("fsync"))(descriptor);
}

int close(int descriptor) {
  const int failed = (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY &&
                     fails_at("close", descriptor),
            error = errno;
  const int result = ((int (*)(int))real("close"))(descriptor);
  if (!failed) return result;
  errno = error;
  return -1;
}

int rename(const char* from, const char* to) {
  return fails("rename", to) ? -1 : ((int (*)(const char*, const char*))real("rename"))(from, to);
}

static int remove_file(const char* name, const char* path) {
  return fails("unlink", path) ? -1 : ((int (*)(const char*))real(name))(path);
}
int unlink(const char* path) { return remove_file("unlink", path); }
int remove(const char* path) { return remove_file("remove", path); }

int mkdir(const char* path, mode_t mode) {
  return fails("mkdir", path) ? -1 : ((int (*)(const char*, mode_t))real("mkdir"))(path, mode);
}

int ftruncate(int descriptor, off_t size) {
  return fails_at("truncate", descriptor)
             ? -1
             : ((int (*)(int, off_t))real("ftruncate"))(descriptor, size);
}

/* Where a file size has 64 bits anyway, the names are two for one function. */
_Static_assert(sizeof(off_t) == 8, "a machine of 64 bits");
int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int ftruncate64(int descriptor, off_t size) __attribute__((alias("ftruncate")));
int fdatasync(int descriptor) __attribute__((alias("fsync")));
